#include "pipeline/scene/models/declared_directions.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>

#include "hal/clock.h"
#include "pipeline/scene/models/model_pose.h"

namespace pleinair::scene {
namespace {

using Triangle = std::array<glm::vec3, 3>;

/// Sine of the angle between an axis and the surface's normal at which the axis begins to count on
/// the surface, and counts fully.
constexpr float kAcross = 0.1F;
constexpr float kAlong = 0.3F;

glm::vec3 unitOf(const glm::vec3& v) {
  const float length = glm::length(v);
  return length > 0.0F ? v / length : glm::vec3(0.0F);
}

float smoothStep(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0F, 1.0F);
  return t * t * (3.0F - 2.0F * t);
}

Triangle placesOf(const Mesh& mesh, const std::array<std::uint32_t, 3>& corners) {
  return {mesh.vertices[corners[0]].position, mesh.vertices[corners[1]].position,
          mesh.vertices[corners[2]].position};
}

/// An axis of the posed triangle's frame, in the frame of the triangle before posing.
glm::vec3 axisOn(const glm::vec3& axis, const Triangle& posed, const Triangle& own) {
  const glm::vec3 a = posed[0] - posed[2];
  const glm::vec3 b = posed[1] - posed[2];
  const glm::mat2 sides(glm::dot(a, a), glm::dot(a, b), glm::dot(a, b), glm::dot(b, b));
  const float determinant = glm::determinant(sides);
  // Triangles without area have no plane.
  if (!(determinant > 1e-10F * sides[0][0] * sides[1][1])) return glm::vec3(0.0F);
  const glm::vec2 at = glm::inverse(sides) * glm::vec2(glm::dot(axis, a), glm::dot(axis, b));
  const float along = glm::length(at.x * a + at.y * b);
  return smoothStep(kAcross, kAlong, along) *
         unitOf(at.x * (own[0] - own[2]) + at.y * (own[1] - own[2]));
}

/// The mean of lines in the triangle's plane.
glm::vec3 meanOf(const Triangle& lines, const Triangle& own) {
  const glm::vec3 u = unitOf(own[1] - own[0]);
  const glm::vec3 n = unitOf(glm::cross(own[1] - own[0], own[2] - own[0]));
  const glm::vec3 v = glm::cross(n, u);
  glm::vec2 sum(0.0F);  // of doubled angles
  for (const glm::vec3& line : lines) {
    const glm::vec2 at(glm::dot(line, u), glm::dot(line, v));
    const float square = glm::dot(at, at);
    if (square > 0.0F) sum += glm::vec2(at.x * at.x - at.y * at.y, 2.0F * at.x * at.y) / square;
  }
  const float angle = 0.5F * std::atan2(sum.y, sum.x);
  return glm::length(sum) / 3.0F * (std::cos(angle) * u + std::sin(angle) * v);
}

}  // namespace

bool declaresDirections(const Model& model, const Mesh& mesh) {
  switch (model.strokeDirection.source) {
    case StrokeDirection::Source::kCurvature:
      return false;
    case StrokeDirection::Source::kTangents:
      return !mesh.tangents.empty();
    case StrokeDirection::Source::kAxis:
    case StrokeDirection::Source::kPicture:
      return true;
  }
  return false;
}

std::vector<glm::vec3> declaredDirections(const Model& model, const ModelPart& part,
                                          std::size_t surface) {
  const Mesh& mesh = model.surfaces[part.firstSurface + surface].mesh;
  assert(declaresDirections(model, mesh));
  std::vector<glm::vec3> found(mesh.triangles.size(), glm::vec3(0.0F));
  const StrokeDirection& declared = model.strokeDirection;
  if (declared.source == StrokeDirection::Source::kTangents) {
    for (std::size_t i = 0; i < found.size(); ++i) {
      const auto& corners = mesh.triangles[i];
      found[i] =
          meanOf({mesh.tangents[corners[0]], mesh.tangents[corners[1]], mesh.tangents[corners[2]]},
                 placesOf(mesh, corners));
    }
  } else if (declared.source == StrokeDirection::Source::kAxis) {
    ModelPose rest;
    poseModel(model, std::nullopt, hal::Duration::zero(), rest);
    std::vector<glm::vec3> posed;
    posed.reserve(mesh.vertices.size());
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      posed.push_back(posedVertex(model, part, surface, i, rest).position);
    }
    for (std::size_t i = 0; i < found.size(); ++i) {
      const auto& corners = mesh.triangles[i];
      found[i] = axisOn(declared.axis, {posed[corners[0]], posed[corners[1]], posed[corners[2]]},
                        placesOf(mesh, corners));
    }
  }
  return found;
}

}  // namespace pleinair::scene
