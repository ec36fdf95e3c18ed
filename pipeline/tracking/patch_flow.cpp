#include "pipeline/tracking/patch_flow.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <glm/geometric.hpp>
#include <opencv2/core/hal/intrin.hpp>

namespace pleinair::tracking {
namespace {

constexpr int kSide = FlowPatch::kSide;
static_assert(kSide == 8, "a row is a vector");
constexpr int kPixels = kSide * kSide;
constexpr int kScaleBits = 4;
constexpr int kScale = 1 << kScaleBits;  // of levels
constexpr int kWeightBits = 6;
constexpr int kWeights = 1 << kWeightBits;  // of a pixel and its neighbour, along an axis
constexpr int kSteps = 3;
constexpr double kEnoughPx = 0.02;  // a smaller step is the last
constexpr double kFarPx = 2.0;      // from the guess: it has gone astray
constexpr double kGuessPx = 0.3;    // how good guesses are

cv::v_int16x8 eight(const std::uint8_t* levels) {
  return cv::v_reinterpret_as_s16(cv::v_load_expand(levels));
}

/// The same two numbers again and again.
cv::v_int16x8 pairs(int even, int odd) {
  const auto low = static_cast<unsigned>(even) & 0xFFFFU;
  return cv::v_reinterpret_as_s16(cv::v_setall_u32(low | static_cast<unsigned>(odd) << 16));
}

}  // namespace

FlowPatch::FlowPatch(const cv::Mat& picture, const cv::Point& middle)
    : corner_(middle - cv::Point(kSide / 2, kSide / 2)) {
  const cv::v_int16x8 ones = cv::v_setall_s16(1);
  cv::v_int32x4 x1 = cv::v_setzero_s32();
  cv::v_int32x4 y1 = x1;
  cv::v_int32x4 xx = x1;
  cv::v_int32x4 xy = x1;
  cv::v_int32x4 yy = x1;
  for (int y = 0; y < kSide; ++y) {
    const auto* const row = picture.ptr<std::uint8_t>(corner_.y + y) + corner_.x;
    const cv::v_int16x8 gx = eight(row + 1) - eight(row - 1);
    const cv::v_int16x8 gy = eight(picture.ptr<std::uint8_t>(corner_.y + y + 1) + corner_.x) -
                             eight(picture.ptr<std::uint8_t>(corner_.y + y - 1) + corner_.x);
    cv::v_store(gradientX_[y], gx);
    cv::v_store(gradientY_[y], gy);
    cv::v_store(levels_[y], eight(row) << kScaleBits);
    x1 = cv::v_dotprod(gx, ones, x1);
    y1 = cv::v_dotprod(gy, ones, y1);
    xx = cv::v_dotprod(gx, gx, xx);
    xy = cv::v_dotprod(gx, gy, xy);
    yy = cv::v_dotprod(gy, gy, yy);
  }
  sumX_ = cv::v_reduce_sum(x1);
  sumY_ = cv::v_reduce_sum(y1);
  xx_ = cv::v_reduce_sum(xx) - sumX_ * sumX_ / kPixels;
  xy_ = cv::v_reduce_sum(xy) - sumX_ * sumY_ / kPixels;
  yy_ = cv::v_reduce_sum(yy) - sumY_ * sumY_ / kPixels;
}

FlowPatch::Sums FlowPatch::compare(const cv::Mat& other, const glm::dvec2& moved) const {
  const int left = cvFloor(moved.x);
  const int top = cvFloor(moved.y);
  const int x0 = corner_.x + left;
  const int y0 = corner_.y + top;
  if (x0 < 0 || y0 < 0 || x0 + kSide >= other.cols || y0 + kSide >= other.rows) return {};
  const int u = cvRound((moved.x - left) * kWeights);
  const int v = cvRound((moved.y - top) * kWeights);
  // Of a pixel and its right neighbour, in pairs; then of those below.
  const cv::v_int16x8 above = pairs((kWeights - u) * (kWeights - v), u * (kWeights - v));
  const cv::v_int16x8 under = pairs((kWeights - u) * v, u * v);
  constexpr int kShift = 2 * kWeightBits - kScaleBits;
  const cv::v_int16x8 ones = cv::v_setall_s16(1);
  cv::v_int32x4 d1 = cv::v_setzero_s32();
  cv::v_int32x4 dx = d1;
  cv::v_int32x4 dy = d1;
  cv::v_int32x4 dd = d1;
  for (int y = 0; y < kSide; ++y) {
    const auto* const row = other.ptr<std::uint8_t>(y0 + y) + x0;
    const auto* const below = other.ptr<std::uint8_t>(y0 + y + 1) + x0;
    cv::v_int16x8 rowLow;
    cv::v_int16x8 rowHigh;
    cv::v_int16x8 belowLow;
    cv::v_int16x8 belowHigh;
    cv::v_zip(eight(row), eight(row + 1), rowLow, rowHigh);
    cv::v_zip(eight(below), eight(below + 1), belowLow, belowHigh);
    const cv::v_int32x4 low = cv::v_dotprod(belowLow, under, cv::v_dotprod(rowLow, above));
    const cv::v_int32x4 high = cv::v_dotprod(belowHigh, under, cv::v_dotprod(rowHigh, above));
    const cv::v_int16x8 difference = cv::v_rshr_pack<kShift>(low, high) - cv::v_load(levels_[y]);
    d1 = cv::v_dotprod(difference, ones, d1);
    dx = cv::v_dotprod(difference, cv::v_load(gradientX_[y]), dx);
    dy = cv::v_dotprod(difference, cv::v_load(gradientY_[y]), dy);
    dd = cv::v_dotprod(difference, difference, dd);
  }
  const double sum = cv::v_reduce_sum(d1);
  const double mean = sum / kPixels;
  return {.x = cv::v_reduce_sum(dx) - mean * sumX_,
          .y = cv::v_reduce_sum(dy) - mean * sumY_,
          .variance = (cv::v_reduce_sum(dd) - mean * sum) /
                      (static_cast<double>(kPixels - 1) * kScale * kScale),
          .isInside = true};
}

PatchMatch FlowPatch::at(const cv::Mat& other, const glm::dvec2& moved) const {
  const Sums sums = compare(other, moved);
  const double determinant = xx_ * yy_ - xy_ * xy_;
  constexpr double kMostPlacing = 100.0;
  const double placing = determinant > 0.0 ? 2.0 * std::sqrt((xx_ + yy_) / determinant) : 1e9;
  return {.moved = moved,
          .variance = sums.variance,
          .placing = std::min(placing, kMostPlacing),
          .isInside = sums.isInside};
}

PatchMatch FlowPatch::refined(const cv::Mat& other, const PatchMatch& guess, double noise) const {
  // A guess is as good as what differences of the noise's size say of so large a shift. Gradients
  // are twice too large.
  const double hold = 4.0 * 2.0 * noise * noise / (kGuessPx * kGuessPx);
  const double xx = xx_ + hold;
  const double yy = yy_ + hold;
  const double determinant = xx * yy - xy_ * xy_;
  glm::dvec2 moved = guess.moved;
  Sums sums = compare(other, moved);
  for (int step = 0; step < kSteps && sums.isInside; ++step) {
    const glm::dvec2 back = hold * (moved - guess.moved);
    constexpr double kUnits = 2.0 / kScale;  // of gradients, squared, over the sums'
    const glm::dvec2 right = kUnits * glm::dvec2(sums.x, sums.y) + back;
    const glm::dvec2 change(-(yy * right.x - xy_ * right.y) / determinant,
                            -(xx * right.y - xy_ * right.x) / determinant);
    moved += change;
    const glm::dvec2 away = moved - guess.moved;
    if (!(glm::dot(away, away) < kFarPx * kFarPx)) return guess;
    sums = compare(other, moved);
    if (glm::dot(change, change) < kEnoughPx * kEnoughPx) break;
  }
  if (!sums.isInside || sums.variance > guess.variance) return guess;
  PatchMatch out = guess;
  out.moved = moved;
  out.variance = sums.variance;
  return out;
}

}  // namespace pleinair::tracking
