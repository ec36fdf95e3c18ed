#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <glm/mat4x4.hpp>

#include "hal/clock.h"
#include "pipeline/scene/models/model.h"
#include "pipeline/scene/models/rig.h"

namespace pleinair::scene {

inline constexpr float kMaxMorphWeight = 1e4F;

/// Pose of a model at one moment; ModelPart's matrix and weight indices refer to it. Keeps its
/// memory from pose to pose.
struct ModelPose {
  /// Each transforms a part's vertices (or the share of one joint) to the model's frame.
  std::vector<glm::dmat4> matrices;
  std::vector<float> weights;            ///< of morph targets
  std::vector<glm::dmat4> rootFromNode;  ///< per node of the rig
  // scratch data
  std::vector<NodePlace> places;             ///< per node
  std::vector<std::size_t> weightsChannels;  ///< channel of the clip per node; kNoChannel for none

  static constexpr std::size_t kNoChannel = static_cast<std::size_t>(-1);
};

/// Computes the pose of `model` at `moment` of a clip (nothing: at rest), after its built-in parts
/// have turned for `turning`. Allocates only if `pose` held less before. Everything in a pose is
/// finite: a node that a clip moves beyond kMaxMatrixValue stays with its parent, and weights are
/// clamped to ±kMaxMorphWeight.
void poseModel(const Model& model, const std::optional<ClipMoment>& moment, hal::Duration turning,
               ModelPose& pose);

/// A vertex of a part (of its `surface`th surface, counted from 0) in `pose`, in the model's frame,
/// with a unit normal: the CPU version of the GPU's computation.
MeshVertex posedVertex(const Model& model, const ModelPart& part, std::size_t surface,
                       std::size_t vertex, const ModelPose& pose);

/// Computes spheres that together hold all vertices in `pose`, in the model's frame: one per
/// surface of a part, or one per joint of it. Cheap enough for each frame; replaces the contents of
/// `spheres`.
void boundingSpheres(const Model& model, const ModelPose& pose,
                     std::vector<BoundingSphere>& spheres);

/// A sphere around all parts in `pose`; never too small, and at most a little too large. Cheap
/// enough for each frame.
BoundingSphere boundingSphere(const Model& model, const ModelPose& pose);

}  // namespace pleinair::scene
