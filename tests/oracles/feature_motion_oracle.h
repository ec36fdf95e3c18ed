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

/// How a point and what is about it moved.
struct PointMotion {
  glm::dvec2 displacement{0.0};
  glm::dmat2 jacobian{1.0};
};

/// The three features that were nearest to the point (thesis §4.3.3). Precondition: three or more.
FeatureTriangle nearestThree(std::span<const FeatureStep> features, glm::dvec2 px);

/// The point keeps its barycentric coordinates in the triangle of the three (thesis eq. 13-19):
/// solved as a linear system. Precondition: the triangle has an area.
PointMotion triangleMotion(const FeatureTriangle& triangle, glm::dvec2 px);

/// The turn, zoom and shift that fits the three best by least squares, in complex numbers: what is
/// left where they are no triangle. Precondition: they are not all in one place.
PointMotion similarityMotion(const FeatureTriangle& triangle, glm::dvec2 px);

/// The least height of the triangle over its longest side: 0 if it is none.
double heightShare(const FeatureTriangle& triangle);
/// Of the point in the triangle: (1, 0, 0) at the first corner.
std::array<double, 3> barycentrics(const FeatureTriangle& triangle, glm::dvec2 px);

}  // namespace pleinair::oracles
