#pragma once

#include <cstddef>

#include <glm/common.hpp>
#include <glm/vec2.hpp>

#include "hal/image.h"

namespace pleinair::calibration {

/// Bilinearly interpolated grey level; pixel centres at +0.5. Precondition: `px` is at least 1 px
/// inside of the image.
inline double greyAt(const hal::PlaneView& luma, const glm::dvec2& px) {
  const glm::dvec2 place = px - 0.5;
  const glm::dvec2 whole = glm::floor(place);
  const glm::dvec2 part = place - whole;
  const std::size_t at =
      static_cast<std::size_t>(whole.y) * luma.strideBytes + static_cast<std::size_t>(whole.x);
  const std::size_t below = at + luma.strideBytes;
  const auto& grey = luma.bytes;
  return glm::mix(glm::mix<double>(grey[at], grey[at + 1], part.x),
                  glm::mix<double>(grey[below], grey[below + 1], part.x), part.y);
}

}  // namespace pleinair::calibration
