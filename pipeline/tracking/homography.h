#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

#include "hal/pixel_format.h"

namespace pleinair::tracking {

/// Where a homography takes a point.
glm::dvec2 movedBy(const glm::dmat3& homography, const glm::dvec2& px);

/// The middles of a grid of fields over a picture: where averages over all of it are taken.
template <class F>
void forPlaces(hal::FrameSize size, F&& visit) {
  constexpr int kAcross = 5;
  constexpr int kDown = 4;
  for (int j = 0; j < kDown; ++j) {
    for (int i = 0; i < kAcross; ++i) {
      visit(glm::dvec2((i + 0.5) / kAcross * size.width, (j + 0.5) / kDown * size.height));
    }
  }
}

/// Root mean square, over a picture, of how far a homography takes its points.
double rmsMotion(const glm::dmat3& homography, hal::FrameSize size);

}  // namespace pleinair::tracking
