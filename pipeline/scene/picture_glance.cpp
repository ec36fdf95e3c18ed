#include "pipeline/scene/picture_glance.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

namespace pleinair::scene {

PictureGlance glanceAt(const LinearPicture& picture) {
  constexpr int kColumns = 40, kRows = 30;
  constexpr double kCount = double{kColumns} * kRows;
  const hal::FrameSize size = picture.size();
  PictureGlance glance;
  glm::dvec2 slope(0.0), squares(0.0);
  double sum = 0.0, sumOfSquares = 0.0;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const glm::vec3 light = picture.at((2 * column + 1) * size.width / (2 * kColumns),
                                         (2 * row + 1) * size.height / (2 * kRows));
      glance.mean += glm::dvec3(light);
      const double doublings = std::log2(double{luminanceOf(light)} + 0.01);
      const glm::dvec2 at((2.0 * column + 1.0) / kColumns - 1.0, (2.0 * row + 1.0) / kRows - 1.0);
      slope += doublings * at;
      squares += at * at;
      sum += doublings;
      sumOfSquares += doublings * doublings;
    }
  }
  glance.mean = glm::max(glance.mean / kCount, glm::dvec3(1e-4));
  glance.slope = slope / squares;
  const double variance = sumOfSquares - sum * sum / kCount;
  const glm::dvec2 ofSlope = glance.slope * glance.slope * squares;
  glance.explained = (ofSlope.x + ofSlope.y) / std::max(variance, 1e-9);
  return glance;
}

}  // namespace pleinair::scene
