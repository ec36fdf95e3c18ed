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

/// Transform of a node to its parent's frame: scale, then rotation, then translation (glTF 2.0,
/// section 3.5).
struct NodePlace {
  glm::dvec3 translation{0.0};
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  ///< unit length
  glm::dvec3 scale{1.0};
};

glm::dmat4 parentFromNode(const NodePlace& place);

inline constexpr double kMaxMatrixValue = 1e9;
/// Whether all numbers are finite and at most kMaxMatrixValue, so that products of such matrices
/// stay finite.
bool isBounded(const glm::dmat4& matrix);

/// A frame with other frames below it: a node of a glTF.
struct RigNode {
  std::optional<std::size_t> parent;  ///< index in Rig::nodes; comes before this node
  NodePlace rest;
  /// Replaces `rest` where a file gives a matrix; such a node is not animated.
  std::optional<glm::dmat4> parentFromNode;
  std::vector<float> weights;  ///< of the morph targets of its mesh, at rest
};

enum class Interpolation { kStep, kLinear, kCubicSpline };
enum class AnimatedProperty { kTranslation, kRotation, kScale, kWeights };

/// The change of one property of a node over time (glTF 2.0, section 3.11 and appendix C).
struct Channel {
  std::size_t node = 0;  ///< index in Rig::nodes
  AnimatedProperty property = AnimatedProperty::kTranslation;
  Interpolation interpolation = Interpolation::kLinear;
  std::vector<float> seconds;  ///< per key, rising, from 0 up; at least one
  /// `width` numbers per key (x y z, x y z w, or one per weight); for cubic splines three times as
  /// many: in-tangent, value, out-tangent.
  std::vector<float> values;
  std::size_t width = 3;
};

/// An animation. Before a channel's first key and after its last the value is constant.
struct Clip {
  std::string name;
  double seconds = 0.0;  ///< time of the last key
  std::vector<Channel> channels;
};

/// The joints that deform a mesh, and for each the transform of the mesh to its frame at rest (the
/// inverse bind matrix).
struct Skin {
  std::vector<std::size_t> joints;  ///< indices in Rig::nodes; at most kMaxJoints
  std::vector<glm::dmat4> jointFromMesh;
};

inline constexpr std::size_t kMaxJoints = 128;       ///< of a skin
inline constexpr std::size_t kMaxMorphTargets = 64;  ///< of a surface

/// The moving parts of a model: a tree of nodes, the clips that move them, and skins.
struct Rig {
  std::vector<RigNode> nodes;
  std::vector<Clip> clips;
  std::vector<Skin> skins;
  glm::dmat4 modelFromRoot{1.0};  ///< to the model's axes
};

/// Evaluates `channel` at `seconds` into `value` (Channel::width numbers; glTF 2.0, appendix C). A
/// rotation is x y z w, of unit length.
void valueAt(const Channel& channel, double seconds, std::span<double> value);

/// How a scene plays a clip of a model.
struct Playback {
  std::optional<std::size_t> clip;  ///< index in Rig::clips; nothing: the model is at rest
  double speed = 1.0;               ///< 2: twice as fast; negative: backwards
  bool loops = true;                ///< false: it stays at its end
  /// Time starts when the tag it is attached to is first seen; otherwise with the first frame.
  bool startsOnSight = false;
};

/// A moment of a clip.
struct ClipMoment {
  std::size_t clip = 0;
  double seconds = 0.0;  ///< 0 … Clip::seconds
};

/// The moment of `playback` at `elapsed` after its start (≥ 0); nothing if it plays no clip.
std::optional<ClipMoment> momentOf(const Rig& rig, const Playback& playback, hal::Duration elapsed);

}  // namespace pleinair::scene
