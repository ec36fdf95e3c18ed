#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "hal/pixel_format.h"

namespace pleinair::measure {

/// Statistics of the number of points per cell.
struct CellCounts {
  std::size_t cells = 0;
  double mean = 0.0;
  double spread = 0.0;  ///< standard deviation
  double empty = 0.0;   ///< share of the cells, in [0, 1]
  int most = 0;

  /// "2.03 ± 0.41, 0.0 % empty".
  std::string text() const;
};

/// The counted cells: those with at least nine tenths of their pixels covered.
class CellGrid {
 public:
  /// `covered`: one value per pixel, row by row.
  CellGrid(hal::FrameSize size, int cellPixels, const std::vector<bool>& covered);

  CellCounts count(std::span<const glm::dvec2> points) const;
  /// Whether the point lies in a counted cell.
  bool holds(glm::dvec2 px) const;
  std::size_t cells() const;

 private:
  std::ptrdiff_t indexAt(glm::dvec2 px) const;

  hal::FrameSize size_;
  int cellPixels_;
  int columns_;
  std::vector<bool> counts_;
};

}  // namespace pleinair::measure
