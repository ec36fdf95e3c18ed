#pragma once

#include <algorithm>
#include <bitset>
#include <cstddef>

#include <glm/vec2.hpp>

#include "hal/pixel_format.h"

namespace pleinair::tracking {

/// 8 × 6 places of a frame, row by row. Places are counted where features would deceive: a plain
/// wall has few of them, a jacket many.
inline constexpr int kPlaceColumns = 8;
inline constexpr int kPlaceRows = 6;
inline constexpr std::size_t kPlaces = std::size_t{kPlaceColumns} * kPlaceRows;
using FeaturePlaces = std::bitset<kPlaces>;

/// The place at a position of the frame; of one beyond it, the nearest.
inline std::size_t placeOf(const glm::dvec2& px, hal::FrameSize size) {
  const auto partOf = [](double along, int sidePx, int parts) {
    return std::clamp(static_cast<int>(parts * along / sidePx), 0, parts - 1);
  };
  const int row = partOf(px.y, size.height, kPlaceRows);
  return static_cast<std::size_t>(kPlaceColumns * row + partOf(px.x, size.width, kPlaceColumns));
}

}  // namespace pleinair::tracking
