#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <glm/vec2.hpp>

#include "hal/pixel_format.h"

namespace pleinair::styles {

/// The m×n grid of cells that a picture is divided into (thesis eq. 1): about one cell per
/// `cellSizePixels` squared, at least one.
class CellGrid {
 public:
  CellGrid(hal::FrameSize picture, int cellSizePixels)
      : cells_(along(picture.width, cellSizePixels), along(picture.height, cellSizePixels)) {}

  /// (n, m): columns and rows.
  glm::ivec2 cells() const { return cells_; }
  hal::FrameSize size() const { return {cells_.x, cells_.y}; }
  std::size_t count() const {
    return static_cast<std::size_t>(cells_.x) * static_cast<std::size_t>(cells_.y);
  }
  /// (W/n, H/m) of a picture of this size, which the cells divide as they do the first.
  glm::vec2 cellPixels(hal::FrameSize size) const {
    return glm::vec2(size.width, size.height) / glm::vec2(cells_);
  }

 private:
  static int along(int pixels, int cellSizePixels) {
    return std::max(1, static_cast<int>(std::lround(static_cast<double>(pixels) / cellSizePixels)));
  }

  glm::ivec2 cells_;
};

}  // namespace pleinair::styles
