#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "hal/clock.h"

namespace pleinair::scene {

/// Where a node is in its parent's frame: scaled, then turned, then moved (glTF 2.0, section 3.5).
struct NodePlace {
  glm::dvec3 translation{0.0};
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  ///< unit length
  glm::dvec3 scale{1.0};
};

glm::dmat4 parentFromNode(const NodePlace& place);

inline constexpr double kMostOfMatrix = 1e9;
/// Whether no number of it is beyond kMostOfMatrix, or none at all: what is made of such matrices
/// stays finite.
bool isBounded(const glm::dmat4& matrix);

/// A frame that others hang on: a node of a glTF.
struct RigNode {
  std::optional<std::size_t> parent;  ///< of Rig::nodes, and before this one
  NodePlace rest;
  /// In place of `rest` where a file gives a matrix; such a node is not animated.
  std::optional<glm::dmat4> parentFromNode;
  std::vector<float> weights;  ///< of the morph targets of what it shows, at rest
};

enum class Interpolation { kStep, kLinear, kCubicSpline };
enum class AnimatedProperty { kTranslation, kRotation, kScale, kWeights };

/// How one property of a node changes (glTF 2.0, section 3.11 and appendix C).
struct Channel {
  std::size_t node = 0;  ///< of Rig::nodes
  AnimatedProperty property = AnimatedProperty::kTranslation;
  Interpolation interpolation = Interpolation::kLinear;
  std::vector<float> seconds;  ///< of each key, rising, from 0 up; at least one
  /// `width` numbers a key (x y z, x y z w, or a weight each); for cubic splines three times as
  /// many: in-tangent, value, out-tangent.
  std::vector<float> values;
  std::size_t width = 3;
};

/// An animation. Before a channel's first key and after its last it stands still.
struct Clip {
  std::string name;
  double seconds = 0.0;  ///< of the last key
  std::vector<Channel> channels;
};

/// What bends a mesh: joints, and what takes the mesh to each joint's frame at rest (the inverse
/// bind matrix).
struct Skin {
  std::vector<std::size_t> joints;  ///< of Rig::nodes; at most kMaxJoints
  std::vector<glm::dmat4> jointFromMesh;
};

inline constexpr std::size_t kMaxJoints = 128;       ///< of a skin
inline constexpr std::size_t kMaxMorphTargets = 64;  ///< of a surface

/// What makes a model move: a tree of nodes, the clips that move them, and skins.
struct Rig {
  std::vector<RigNode> nodes;
  std::vector<Clip> clips;
  std::vector<Skin> skins;
  glm::dmat4 modelFromRoot{1.0};  ///< into the model's axes
};

/// What `channel` says at `seconds`, into `value` (of Channel::width numbers; glTF 2.0, appendix
/// C). A rotation is x y z w, of unit length.
void valueAt(const Channel& channel, double seconds, std::span<double> value);

/// How a model's clip is played in a scene.
struct Playback {
  std::optional<std::size_t> clip;  ///< of Rig::clips; nothing: it stands at rest
  double speed = 1.0;               ///< 2: twice as fast; negative: backwards
  bool loops = true;                ///< else it stays as it ends
  /// Time starts when what it is attached to is first seen; else with the first frame.
  bool startsOnSight = false;
};

/// A moment of a clip.
struct ClipMoment {
  std::size_t clip = 0;
  double seconds = 0.0;  ///< 0 … Clip::seconds
};

/// Where `playback` is `elapsed` after its start (≥ 0); nothing where it plays none.
std::optional<ClipMoment> momentOf(const Rig& rig, const Playback& playback, hal::Duration elapsed);

}  // namespace pleinair::scene
