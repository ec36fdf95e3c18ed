#include "pipeline/measure/baselines/cell_counts.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace pleinair::measure {

std::string CellCounts::text() const {
  return fmt::format("{:.2f} ± {:.2f}, {:.1f} % empty", mean, spread, 100.0 * empty);
}

CellGrid::CellGrid(hal::FrameSize size, int cellPixels, const std::vector<bool>& covered)
    : size_(size), cellPixels_(cellPixels), columns_(size.width / cellPixels) {
  const int rows = size.height / cellPixels;
  for (int cell = 0; cell < columns_ * rows; ++cell) {
    const int left = cell % columns_ * cellPixels;
    const int top = cell / columns_ * cellPixels;
    int seen = 0;
    for (int y = top; y < top + cellPixels; ++y) {
      for (int x = left; x < left + cellPixels; ++x) {
        seen += covered[static_cast<std::size_t>(y * size.width + x)] ? 1 : 0;
      }
    }
    counts_.push_back(10 * seen >= 9 * cellPixels * cellPixels);
  }
}

std::size_t CellGrid::cells() const {
  return static_cast<std::size_t>(std::ranges::count(counts_, true));
}

std::ptrdiff_t CellGrid::indexAt(glm::dvec2 px) const {
  const int x = static_cast<int>(std::floor(px.x / cellPixels_));
  const int y = static_cast<int>(std::floor(px.y / cellPixels_));
  const bool isInside = x >= 0 && y >= 0 && x < columns_ && y < size_.height / cellPixels_;
  return isInside ? y * columns_ + x : -1;
}

bool CellGrid::holds(glm::dvec2 px) const {
  const std::ptrdiff_t index = indexAt(px);
  return index >= 0 && counts_[static_cast<std::size_t>(index)];
}

CellCounts CellGrid::count(std::span<const glm::dvec2> points) const {
  std::vector<int> held(counts_.size());
  for (const glm::dvec2 px : points) {
    if (holds(px)) ++held[static_cast<std::size_t>(indexAt(px))];
  }
  CellCounts all{.cells = cells()};
  if (all.cells == 0) return all;
  double squares = 0.0;
  for (std::size_t i = 0; i < held.size(); ++i) {
    if (!counts_[i]) continue;
    all.mean += held[i];
    squares += held[i] * held[i];
    all.empty += held[i] == 0 ? 1.0 : 0.0;
    all.most = std::max(all.most, held[i]);
  }
  const auto number = static_cast<double>(all.cells);
  all.mean /= number;
  all.empty /= number;
  all.spread = std::sqrt(std::max(0.0, squares / number - all.mean * all.mean));
  return all;
}

}  // namespace pleinair::measure
