#pragma once

#include <cstddef>

#include <glm/common.hpp>
#include <glm/vec2.hpp>

#include "hal/image.h"

namespace pleinair::calibration {

/// The grey level at a place, between pixels bilinearly; pixel centres at +0.5. Precondition: at
/// least 1 px inside of the picture.
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
