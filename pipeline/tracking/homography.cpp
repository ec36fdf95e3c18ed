#include "pipeline/tracking/homography.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace pleinair::tracking {

glm::dvec2 movedBy(const glm::dmat3& homography, const glm::dvec2& px) {
  const glm::dvec3 to = homography * glm::dvec3(px, 1.0);
  return glm::dvec2(to) / to.z;
}

double rmsMotion(const glm::dmat3& homography, hal::FrameSize size) {
  double sum = 0.0;
  double count = 0.0;
  forPlaces(size, [&](const glm::dvec2& px) {
    const glm::dvec2 step = movedBy(homography, px) - px;
    sum += glm::dot(step, step);
    count += 1.0;
  });
  return std::sqrt(sum / count);
}

}  // namespace pleinair::tracking
