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
  std::uint32_t firstMatrix = 0;           ///< index in ModelPose::matrices; joints count from it
  std::uint32_t normal = 0;                ///< octahedral, two 16-bit snorms
  std::uint32_t joints = 0;                ///< four of 8 bits, the first lowest
  std::array<std::uint32_t, 2> weights{};  ///< four 16-bit unorms
};
static_assert(sizeof(RestVertex) == 32);

/// The vertex attributes that do not move.
struct VertexAttributes {
  glm::vec2 texture{0.0F};
  glm::u16vec4 colour{0};  ///< linear light; 8 bits would band in the dark
};
static_assert(sizeof(VertexAttributes) == 16);

/// The offset of a vertex by a morph target.
struct MorphDelta {
  glm::vec4 position{0.0F};  ///< w unused
  glm::vec4 normal{0.0F};
};

/// Corners of a triangle (in DrawnModel::rest), and its part (in Model::parts).
struct DrawnTriangle {
  std::array<std::uint32_t, 3> corners{};
  std::uint32_t part = 0;
};

/// The form of a triangle's surface, as shaders/surface_form.glsl reads it. From the lowest bit: 12
/// bits of its patch (modulo 4096; unlike those of other parts and materials); 12 bits of the angle
/// of its direction, a line at the angle k · π / 4096, in the coordinates in which the triangle's
/// first corner is (1, 0), its second (0, 1) and its last the origin; 5 bits of the direction's
/// clarity; TriangleForm::isOnLimb; isAtJoint; whether the model declares the direction.
using DrawnForm = std::uint32_t;

/// Vertices that are posed in the same way. Deltas are stored target by target, `vertexCount` each.
struct PoseRange {
  std::uint32_t firstVertex = 0;
  std::uint32_t vertexCount = 0;
  std::uint32_t targetCount = 0;  ///< number of morph targets; 0: joints alone
  std::uint32_t firstDelta = 0;
  std::uint32_t firstWeight = 0;  ///< index in ModelPose::weights
};

/// Triangles of one material, drawn together.
struct DrawBatch {
  std::size_t material = 0;
  std::uint32_t firstIndex = 0;
  std::uint32_t indexCount = 0;
};

/// A model prepared for drawing: the surfaces of all parts are laid out so that each drawn triangle
/// has a number (ArFrame::ids) and each of its vertices its own pose.
///
/// A triangle's number is that of its provoking (last) vertex: the first triangleCount() vertices
/// are the provoking ones, in order; the others follow. So a mesh needs about one vertex per
/// triangle, and no attribute for the number.
struct DrawnModel {
  explicit DrawnModel(const Model& model);

  std::vector<RestVertex> rest;
  std::vector<VertexAttributes> attributes;  ///< one per element of `rest`
  std::vector<DrawnTriangle> triangles;
  std::vector<DrawnForm> forms;        ///< one per triangle
  std::vector<std::uint32_t> indices;  ///< of all batches
  std::vector<DrawBatch> batches;
  std::vector<PoseRange> ranges;  ///< cover each vertex once
  std::vector<MorphDelta> deltas;
};

/// Encodes a unit vector as two 16-bit snorms (Cigolle et al., "A Survey of Efficient
/// Representations for Independent Unit Vectors", 2014); shaders/octahedral.glsl decodes it.
std::uint32_t octahedral(const glm::vec3& unit);

}  // namespace pleinair::scene
