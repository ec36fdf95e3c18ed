#include "pipeline/measure/voronoi_tiling.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include <opencv2/core.hpp>

namespace pleinair::measure {
namespace {

constexpr int kCellPixels = 8;

}  // namespace

VoronoiTiling::VoronoiTiling(cv::Size size, std::uint64_t seed) : tiles_(size) {
  const int columns = (size.width + kCellPixels - 1) / kCellPixels;
  const int rows = (size.height + kCellPixels - 1) / kCellPixels;
  count_ = columns * rows;
  // Sequences of neighbouring seeds would begin alike.
  constexpr std::uint64_t kSpread = 0x9E3779B97F4A7C15U;
  cv::RNG random((seed + 1) * kSpread);
  std::vector<cv::Point2f> seeds;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const float x = random.uniform(0.0F, static_cast<float>(kCellPixels));
      const float y = random.uniform(0.0F, static_cast<float>(kCellPixels));
      seeds.emplace_back(static_cast<float>(column * kCellPixels) + x,
                         static_cast<float>(row * kCellPixels) + y);
    }
  }
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const cv::Point2f centre(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
      // The seed of a pixel's own square is within the square's diagonal: no seed further than two
      // squares away is nearer.
      const int column = x / kCellPixels;
      const int row = y / kCellPixels;
      float nearest = std::numeric_limits<float>::infinity();
      for (int r = std::max(row - 2, 0); r <= std::min(row + 2, rows - 1); ++r) {
        for (int c = std::max(column - 2, 0); c <= std::min(column + 2, columns - 1); ++c) {
          const int index = r * columns + c;
          const cv::Point2f to = seeds[static_cast<std::size_t>(index)] - centre;
          const float distance = to.dot(to);
          if (distance >= nearest) continue;
          nearest = distance;
          tiles_(y, x) = index;
        }
      }
    }
  }
}

cv::Mat3f VoronoiTiling::paint(const cv::Mat3f& picture) const {
  assert(picture.size() == tiles_.size());
  std::vector<cv::Vec4f> sums(static_cast<std::size_t>(count_), cv::Vec4f());
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const cv::Vec3f& color = picture(y, x);
      sums[static_cast<std::size_t>(tiles_(y, x))] += cv::Vec4f(color[0], color[1], color[2], 1);
    }
  }
  cv::Mat3f painted(picture.size());
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const cv::Vec4f& sum = sums[static_cast<std::size_t>(tiles_(y, x))];
      painted(y, x) = cv::Vec3f(sum[0], sum[1], sum[2]) * (1.0F / sum[3]);
    }
  }
  return painted;
}

}  // namespace pleinair::measure
