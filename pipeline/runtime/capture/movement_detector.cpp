#include "pipeline/runtime/capture/movement_detector.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "hal/median.h"

namespace pleinair::runtime {
namespace {

/// Rows that are read of each cell.
constexpr int kSampledRows = 4;
/// Weight of a new grid in the mean: a time constant of one second.
constexpr float kLearning = 0.25F;
/// A cell moves if it differs by so many standard deviations of the noise, in 8-bit levels within
/// these bounds. A person who walks past changes it by 10 to 100 levels.
constexpr float kDeviations = 6.0F;
constexpr float kLeastLevels = 4.0F;
constexpr float kMostLevels = 12.0F;
/// As many cells as a hand at 3 m covers.
constexpr int kLeastCells = 3;
/// Standard deviation of a normal distribution over its median absolute deviation.
constexpr float kDeviationOfMedian = 1.4826F;

}  // namespace

bool MovementDetector::look(const hal::FrameImage& image, hal::TimePoint captured) {
  const bool isFirst = format_ != image.format;
  if (!isFirst && captured - lookedAt_ < kInterval) return false;
  lookedAt_ = captured;
  const Grid grid = gridOf(image.map().view());
  const bool moved = !isFirst && hasMoved(grid);
  for (std::size_t i = 0; i < kCells; ++i) {
    usual_[i] = isFirst ? grid[i] : usual_[i] + kLearning * (grid[i] - usual_[i]);
  }
  format_ = image.format;
  return moved;
}

/// The mean of the bytes of the first plane in each cell: luma, or its mean with chroma, or the
/// mean of colours; any of them shows what moves.
MovementDetector::Grid MovementDetector::gridOf(const hal::ImageView& image) {
  Grid grid{};
  const int height = image.format.size.height;
  const std::size_t rowBytes = image.row(0, 0).size();
  for (int row = 0; row < kRows; ++row) {
    std::array<std::uint32_t, kColumns> sums{};
    for (int i = 0; i < kSampledRows; ++i) {
      const int y = (height * (row * kSampledRows + i)) / (kRows * kSampledRows);
      const std::span<const std::uint8_t> bytes = image.row(0, y);
      for (std::size_t column = 0; column < kColumns; ++column) {
        const std::size_t begin = rowBytes * column / kColumns;
        const std::size_t end = std::max(begin + 1, rowBytes * (column + 1) / kColumns);
        for (std::size_t x = begin; x < std::min(end, rowBytes); ++x) sums.at(column) += bytes[x];
      }
    }
    for (std::size_t column = 0; column < kColumns; ++column) {
      const std::size_t begin = rowBytes * column / kColumns;
      const std::size_t end = std::max(begin + 1, rowBytes * (column + 1) / kColumns);
      const auto count = static_cast<float>((end - begin) * kSampledRows);
      grid.at(static_cast<std::size_t>(row) * kColumns + column) =
          static_cast<float>(sums.at(column)) / count;
    }
  }
  return grid;
}

bool MovementDetector::hasMoved(const Grid& grid) {
  for (std::size_t i = 0; i < kCells; ++i) changes_[i] = grid[i] - usual_[i];
  sorted_ = changes_;
  const float common = hal::medianOf(sorted_);
  for (std::size_t i = 0; i < kCells; ++i) sorted_[i] = std::abs(changes_[i] - common);
  const float noise = kDeviationOfMedian * hal::medianOf(sorted_);
  const float least = std::clamp(kDeviations * noise, kLeastLevels, kMostLevels);
  const auto moves = [&](float change) { return std::abs(change - common) >= least; };
  return std::ranges::count_if(changes_, moves) >= kLeastCells;
}

}  // namespace pleinair::runtime
