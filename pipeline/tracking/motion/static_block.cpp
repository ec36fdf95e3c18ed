#include "pipeline/tracking/motion/static_block.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>

#include <opencv2/core/hal/intrin.hpp>

namespace pleinair::tracking {
namespace {

/// Sums the products of two rows of a block.
int product(const std::int16_t* a, const std::int16_t* b) {
  static_assert(StaticBlock::kSide == 16, "a row is two vectors");
  const cv::v_int32x4 first = cv::v_dotprod(cv::v_load(a), cv::v_load(b));
  return cv::v_reduce_sum(cv::v_dotprod(cv::v_load(a + 8), cv::v_load(b + 8), first));
}

int total(const std::int16_t* a) {
  const cv::v_int16x8 ones = cv::v_setall_s16(1);
  const cv::v_int32x4 first = cv::v_dotprod(cv::v_load(a), ones);
  return cv::v_reduce_sum(cv::v_dotprod(cv::v_load(a + 8), ones, first));
}

}  // namespace

void StaticBlock::restart(const cv::Mat& picture, const cv::Point& corner) {
  sum_.fill(0);
  frames_ = 0;
  add(picture, corner);
}

void StaticBlock::add(const cv::Mat& picture, const cv::Point& corner) {
  assert(frames_ < kReferenceFrames);
  for (int y = 0; y < kTile; ++y) {
    const auto* const row =
        picture.ptr<std::uint8_t>(std::clamp(corner.y + y - 1, 0, picture.rows - 1));
    std::int16_t* const sums = &sum_[static_cast<std::size_t>(y) * kTile];
    for (int x = 0; x < kTile; ++x) {
      const int at = std::clamp(corner.x + x - 1, 0, picture.cols - 1);
      sums[x] = static_cast<std::int16_t>(sums[x] + row[at]);
    }
  }
  ++frames_;
  finish();
}

void StaticBlock::finish() {
  for (std::size_t i = 0; i < sum_.size(); ++i) {
    mean_[i] = static_cast<std::int16_t>((kScale * sum_[i] + frames_ / 2) / frames_);
  }
  int xx = 0;
  int xy = 0;
  int yy = 0;
  int xm = 0;
  int ym = 0;
  int mm = 0;
  int x1 = 0;
  int y1 = 0;
  int m1 = 0;
  for (int y = 0; y < kSide; ++y) {
    const std::int16_t* const mean = &mean_[static_cast<std::size_t>(y + 1) * kTile + 1];
    std::int16_t* const gx = &x_[static_cast<std::size_t>(y) * kSide];
    std::int16_t* const gy = &y_[static_cast<std::size_t>(y) * kSide];
    for (int x = 0; x < kSide; ++x) {
      gx[x] = static_cast<std::int16_t>(mean[x + 1] - mean[x - 1]);
      gy[x] = static_cast<std::int16_t>(mean[x + kTile] - mean[x - kTile]);
    }
    xx += product(gx, gx);
    xy += product(gx, gy);
    yy += product(gy, gy);
    xm += product(gx, mean);
    ym += product(gy, mean);
    mm += product(mean, mean);
    x1 += total(gx);
    y1 += total(gy);
    m1 += total(mean);
  }
  const cv::Matx44d normal(xx, xy, x1, xm, xy, yy, y1, ym, x1, y1, kPixels, m1, xm, ym, m1, mm);
  // A flat block has no measurable shift or contrast.
  constexpr double kRegularisation = 1.0;
  inverse_ = (normal + kRegularisation * cv::Matx44d::eye()).inv(cv::DECOMP_CHOLESKY);
}

StaticBlock::Change StaticBlock::compare(const cv::Mat& picture, const cv::Point& corner) const {
  int dx = 0;
  int dy = 0;
  int d1 = 0;
  int dm = 0;
  int dd = 0;
  for (int y = 0; y < kSide; ++y) {
    const std::uint8_t* const row = picture.ptr<std::uint8_t>(corner.y + y) + corner.x;
    const std::int16_t* const mean = &mean_[static_cast<std::size_t>(y + 1) * kTile + 1];
    std::array<std::int16_t, kSide> difference{};
    for (int x = 0; x < kSide; ++x) {
      difference[static_cast<std::size_t>(x)] =
          static_cast<std::int16_t>(kScale * row[x] - mean[x]);
    }
    dx += product(difference.data(), &x_[static_cast<std::size_t>(y) * kSide]);
    dy += product(difference.data(), &y_[static_cast<std::size_t>(y) * kSide]);
    dm += product(difference.data(), mean);
    dd += product(difference.data(), difference.data());
    d1 += total(difference.data());
  }
  const cv::Vec4d right(dx, dy, d1, dm);
  const cv::Vec4d found = inverse_ * right;
  constexpr int kFreedoms = 4;
  // Gradients are differences over two pixels, twice too large. An image moved by s changes by
  // minus s times its gradient.
  constexpr double kGradient = 2.0;
  return {
      .movedPx = -kGradient * glm::dvec2(found[0], found[1]),
      .placing = kGradient * kScale * std::sqrt(inverse_(0, 0) + inverse_(1, 1)),
      .variance = std::max(0.0, dd - found.dot(right)) / ((kPixels - kFreedoms) * kScale * kScale)};
}

double spatialNoise(const cv::Mat& picture, const cv::Point& corner, int side) {
  int sum = 0;
  for (int y = corner.y; y < corner.y + side; ++y) {
    const auto* const above = picture.ptr<std::uint8_t>(y - 1);
    const auto* const row = picture.ptr<std::uint8_t>(y);
    const auto* const below = picture.ptr<std::uint8_t>(y + 1);
    for (int x = corner.x; x < corner.x + side; ++x) {
      sum += std::abs(above[x - 1] - 2 * above[x] + above[x + 1] - 2 * row[x - 1] + 4 * row[x] -
                      2 * row[x + 1] + below[x - 1] - 2 * below[x] + below[x + 1]);
    }
  }
  // Mean magnitude of a normal variable of deviation 1.
  constexpr double kMeanOfNormal = 0.79788456;
  constexpr double kFilterNorm = 6.0;
  return sum / (kMeanOfNormal * kFilterNorm * side * side);
}

}  // namespace pleinair::tracking
