#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <glm/mat4x4.hpp>

#include "hal/clock.h"
#include "pipeline/scene/models/model.h"
#include "pipeline/scene/models/rig.h"

namespace pleinair::scene {

inline constexpr float kMostOfWeight = 1e4F;

/// How a model stands at one moment; what ModelPart's matrices and weights count in. Keeps its
/// memory from pose to pose.
struct ModelPose {
  /// Each takes a part's vertices (or what of them a joint holds) to the model's frame.
  std::vector<glm::dmat4> matrices;
  std::vector<float> weights;            ///< of morph targets
  std::vector<glm::dmat4> rootFromNode;  ///< of each node of the rig
  // what it is worked out with
  std::vector<NodePlace> places;             ///< of each node
  std::vector<std::size_t> weightsChannels;  ///< of the clip; for each node, kNoChannel for none

  static constexpr std::size_t kNoChannel = static_cast<std::size_t>(-1);
};

/// Poses `model` as it is at `moment` of a clip (nothing: at rest) and after its built-in parts
/// have turned for `turning`. Allocates only where `pose` has held less. Everything in a pose is
/// finite: a node that a clip takes beyond kMostOfMatrix stays with its parent, and weights are
/// kept within ±kMostOfWeight.
void poseModel(const Model& model, const std::optional<ClipMoment>& moment, hal::Duration turning,
               ModelPose& pose);

/// A vertex of a part (of its `surface`th surface, counted from 0) as `pose` has it, in the model's
/// frame, the normal of unit length: what the GPU computes, on the CPU.
MeshVertex posedVertex(const Model& model, const ModelPart& part, std::size_t surface,
                       std::size_t vertex, const ModelPose& pose);

/// Spheres that hold all vertices together as `pose` has them, in the model's frame: one for each
/// surface of a part, or for what each joint holds of it. Cheap enough for each frame; replaces
/// what is in `spheres`.
void boundingSpheres(const Model& model, const ModelPose& pose,
                     std::vector<BoundingSphere>& spheres);

/// Around all parts as `pose` has them; never too small, and at most a little too large. Cheap
/// enough for each frame.
BoundingSphere boundingSphere(const Model& model, const ModelPose& pose);

}  // namespace pleinair::scene
