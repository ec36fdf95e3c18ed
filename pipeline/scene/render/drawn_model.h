#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/gtc/type_precision.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "pipeline/scene/models/model.h"

namespace pleinair::scene {

/// A vertex at rest, as the posing shader reads it (shaders/posing.glsl).
struct RestVertex {
  glm::vec3 position{0.0F};
  std::uint32_t firstMatrix = 0;           ///< of ModelPose::matrices; the joints count from it
  std::uint32_t normal = 0;                ///< octahedral, two 16-bit snorms
  std::uint32_t joints = 0;                ///< four of 8 bits, the first lowest
  std::array<std::uint32_t, 2> weights{};  ///< four 16-bit unorms
};
static_assert(sizeof(RestVertex) == 32);

/// What of a vertex does not move.
struct LookVertex {
  glm::vec2 texture{0.0F};
  glm::u16vec4 colour{0};  ///< linear light; 8 bits would band in the dark
};
static_assert(sizeof(LookVertex) == 16);

/// What a morph target adds to a vertex.
struct MorphDelta {
  glm::vec4 position{0.0F};  ///< w unused
  glm::vec4 normal{0.0F};
};

/// A triangle's corners (of DrawnModel::rest) and its part (of Model::parts).
struct DrawnTriangle {
  std::array<std::uint32_t, 3> corners{};
  std::uint32_t part = 0;
};

/// Vertices that are posed alike. Deltas lie target by target, each `vertexCount` long.
struct PoseRange {
  std::uint32_t firstVertex = 0;
  std::uint32_t vertexCount = 0;
  std::uint32_t targetCount = 0;  ///< morph targets; 0: joints alone
  std::uint32_t firstDelta = 0;
  std::uint32_t firstWeight = 0;  ///< of ModelPose::weights
};

/// Triangles of one material, drawn together.
struct DrawBatch {
  std::size_t material = 0;
  std::uint32_t firstIndex = 0;
  std::uint32_t indexCount = 0;
};

/// A model as it is drawn: each part's surfaces written out, so that each drawn triangle has a
/// number (ArFrame::ids) and each of its vertices a pose of its own.
///
/// A triangle's number is that of its provoking (last) vertex: the first triangleCount() vertices
/// are those, in order; what no triangle is provoked by follows. So a mesh needs about a vertex a
/// triangle, and no attribute for the number.
struct DrawnModel {
  explicit DrawnModel(const Model& model);

  std::vector<RestVertex> rest;
  std::vector<LookVertex> looks;  ///< one for each of `rest`
  std::vector<DrawnTriangle> triangles;
  std::vector<std::uint32_t> indices;  ///< of all batches
  std::vector<DrawBatch> batches;
  std::vector<PoseRange> ranges;  ///< cover all vertices once
  std::vector<MorphDelta> deltas;
};

/// A unit vector as two 16-bit snorms (Cigolle et al., "A Survey of Efficient Representations for
/// Independent Unit Vectors", 2014); what shaders/octahedral.glsl reads.
std::uint32_t octahedral(const glm::vec3& unit);

}  // namespace pleinair::scene
