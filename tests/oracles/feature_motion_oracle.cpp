#include "tests/oracles/feature_motion_oracle.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace pleinair::oracles {
namespace {

using Complex = std::complex<double>;

Complex complexOf(glm::dvec2 v) {
  return {v.x, v.y};
}

/// The corners as columns (x, y, 1), which map barycentrics to the point (eq. 13).
glm::dmat3 cornersOf(const FeatureTriangle& triangle, glm::dvec2 FeatureStep::*place) {
  return {glm::dvec3(triangle[0].*place, 1.0), glm::dvec3(triangle[1].*place, 1.0),
          glm::dvec3(triangle[2].*place, 1.0)};
}

}  // namespace

FeatureTriangle nearestThree(std::span<const FeatureStep> features, glm::dvec2 px) {
  std::vector<FeatureStep> sorted(features.begin(), features.end());
  std::ranges::stable_sort(sorted, {}, [&](const FeatureStep& each) {
    return glm::dot(each.then - px, each.then - px);
  });
  return {sorted.at(0), sorted.at(1), sorted.at(2)};
}

PointMotion triangleMotion(const FeatureTriangle& triangle, glm::dvec2 px) {
  const glm::dmat3 currentFromPrevious = cornersOf(triangle, &FeatureStep::now) *
                                         glm::inverse(cornersOf(triangle, &FeatureStep::then));
  return {.displacement = glm::dvec2(currentFromPrevious * glm::dvec3(px, 1.0)) - px,
          .jacobian = glm::dmat2(currentFromPrevious)};
}

PointMotion similarityMotion(const FeatureTriangle& triangle, glm::dvec2 px) {
  Complex previousMiddle;
  Complex nowMiddle;
  for (const FeatureStep& each : triangle) {
    previousMiddle += complexOf(each.then) / 3.0;
    nowMiddle += complexOf(each.now) / 3.0;
  }
  Complex product;
  double spread = 0.0;
  for (const FeatureStep& each : triangle) {
    const Complex then = complexOf(each.then) - previousMiddle;
    product += std::conj(then) * (complexOf(each.now) - nowMiddle);
    spread += std::norm(then);
  }
  const Complex turn = product / spread;
  const Complex now = nowMiddle + turn * (complexOf(px) - previousMiddle);
  return {.displacement = glm::dvec2(now.real(), now.imag()) - px,
          .jacobian = {turn.real(), turn.imag(), -turn.imag(), turn.real()}};
}

double heightShare(const FeatureTriangle& triangle) {
  const glm::dvec2 u = triangle[1].then - triangle[0].then;
  const glm::dvec2 v = triangle[2].then - triangle[0].then;
  const double longest = std::max({glm::length(u), glm::length(v), glm::length(u - v)});
  return longest > 0.0 ? std::abs(u.x * v.y - u.y * v.x) / (longest * longest) : 0.0;
}

std::array<double, 3> barycentrics(const FeatureTriangle& triangle, glm::dvec2 px) {
  const glm::dvec3 at = glm::inverse(cornersOf(triangle, &FeatureStep::then)) * glm::dvec3(px, 1.0);
  return {at.x, at.y, at.z};
}

}  // namespace pleinair::oracles
