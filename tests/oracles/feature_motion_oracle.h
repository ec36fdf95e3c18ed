#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>

namespace pleinair::oracles {

/// A tracked feature in two frames, px.
struct FeatureStep {
  glm::dvec2 then{0.0};
  glm::dvec2 now{0.0};
};
using FeatureTriangle = std::array<FeatureStep, 3>;

/// The motion of a point and its surroundings.
struct PointMotion {
  glm::dvec2 displacement{0.0};
  glm::dmat2 jacobian{1.0};
};

/// The three features nearest to the point (thesis §4.3.3). Precondition: three or more.
FeatureTriangle nearestThree(std::span<const FeatureStep> features, glm::dvec2 px);

/// Motion that keeps the point's barycentric coordinates in the triangle (thesis eq. 13-19), solved
/// as a linear system. Precondition: the triangle has an area.
PointMotion triangleMotion(const FeatureTriangle& triangle, glm::dvec2 px);

/// The least-squares rotation, zoom and shift for the three, in complex numbers: the fallback for
/// degenerate triangles. Precondition: they are not all in one place.
PointMotion similarityMotion(const FeatureTriangle& triangle, glm::dvec2 px);

/// The smallest height of the triangle over its longest side: 0 if degenerate.
double heightShare(const FeatureTriangle& triangle);
/// The point's barycentric coordinates in the triangle: (1, 0, 0) at the first corner.
std::array<double, 3> barycentrics(const FeatureTriangle& triangle, glm::dvec2 px);

}  // namespace pleinair::oracles
