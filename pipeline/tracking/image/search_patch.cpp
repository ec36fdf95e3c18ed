#include "pipeline/tracking/image/search_patch.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <glm/geometric.hpp>
#include <opencv2/core/hal/intrin.hpp>

namespace pleinair::tracking {
namespace {

constexpr int kLanes = 8;  // int16 values in a vector
constexpr int kScaleBits = 4;
constexpr int kScale = 1 << kScaleBits;  // fixed-point scale of differences; 1 is a grey level
constexpr int kWeightBits = 6;
// Fixed-point scale of an interpolation weight along one axis.
constexpr int kWeights = 1 << kWeightBits;
constexpr int kSteps = 3;
constexpr double kConvergedPx = 0.02;  // stop at a smaller step
constexpr double kDivergedPx = 2.0;    // from the guess: the search has diverged

cv::v_int16x8 eight(const std::uint8_t* levels) {
  return cv::v_reinterpret_as_s16(cv::v_load_expand(levels));
}

/// A vector that repeats two numbers.
cv::v_int16x8 pairs(int even, int odd) {
  const auto low = static_cast<unsigned>(even) & 0xFFFFU;
  return cv::v_reinterpret_as_s16(cv::v_setall_u32(low | static_cast<unsigned>(odd) << 16));
}

/// Accumulates products of vectors.
class Sum {
 public:
  void add(const cv::v_int16x8& a, const cv::v_int16x8& b) { sum_ = cv::v_dotprod(a, b, sum_); }
  double get() const { return cv::v_reduce_sum(sum_); }

 private:
  cv::v_int32x4 sum_ = cv::v_setzero_s32();
};

}  // namespace

template <int kSide>
SearchPatch<kSide>::SearchPatch(const cv::Mat& picture, const cv::Point& middle)
    : corner_(middle - cv::Point(kSide / 2, kSide / 2)) {
  static_assert(kSide % kLanes == 0);
  const cv::v_int16x8 ones = cv::v_setall_s16(1);
  Sum x1, y1, m1, xx, xy, yy, mm;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; x += kLanes) {
      const int at = corner_.x + x;
      const auto* const row = picture.ptr<std::uint8_t>(corner_.y + y) + at;
      const cv::v_int16x8 level = eight(row);
      const cv::v_int16x8 gx = eight(row + 1) - eight(row - 1);
      const cv::v_int16x8 gy = eight(picture.ptr<std::uint8_t>(corner_.y + y + 1) + at) -
                               eight(picture.ptr<std::uint8_t>(corner_.y + y - 1) + at);
      cv::v_store(&levels_[y][x], level);
      cv::v_store(&gradientX_[y][x], gx);
      cv::v_store(&gradientY_[y][x], gy);
      x1.add(gx, ones);
      y1.add(gy, ones);
      m1.add(level, ones);
      xx.add(gx, gx);
      xy.add(gx, gy);
      yy.add(gy, gy);
      mm.add(level, level);
    }
  }
  constexpr double kPixels = kSide * kSide;
  meanX_ = x1.get() / kPixels;
  meanY_ = y1.get() / kPixels;
  xx_ = xx.get() - meanX_ * x1.get();
  xy_ = xy.get() - meanX_ * y1.get();
  yy_ = yy.get() - meanY_ * y1.get();
  contrast_ = std::sqrt(std::max(0.0, mm.get() / kPixels - std::pow(m1.get() / kPixels, 2)));
}

template <int kSide>
cv::Point SearchPatch<kSide>::middleNear(const cv::Mat& picture, const cv::Point2f& point) {
  return {std::clamp(cvRound(point.x + 0.5F), kReach, picture.cols - kReach),
          std::clamp(cvRound(point.y + 0.5F), kReach, picture.rows - kReach)};
}

template <int kSide>
double SearchPatch<kSide>::placing(double noise, bool isBrightnessKnown) const {
  // Noise alone has gradients too: each difference holds twice its variance. The gradients that
  // remain are uncertain where there is little more than that.
  constexpr double kMinRemaining = 0.25;
  const double flat = 2.0 * noise * noise * kSide * kSide;
  const double known = isBrightnessKnown ? kSide * kSide : 0.0;
  const double allX = xx_ + known * meanX_ * meanX_;
  const double allY = yy_ + known * meanY_ * meanY_;
  const double xy = xy_ + known * meanX_ * meanY_;
  const double xx = std::max(kMinRemaining * allX, allX - flat);
  const double yy = std::max(kMinRemaining * allY, allY - flat);
  const double determinant = xx * yy - xy * xy;
  if (!(determinant > 0.0)) return kMaxPlacing;
  return std::min(2.0 * std::sqrt((xx + yy) / determinant), kMaxPlacing);
}

template <int kSide>
typename SearchPatch<kSide>::Sums SearchPatch<kSide>::compare(const cv::Mat& other,
                                                              const glm::dvec2& moved) const {
  const int left = cvFloor(moved.x);
  const int top = cvFloor(moved.y);
  const int x0 = corner_.x + left;
  const int y0 = corner_.y + top;
  if (x0 < 0 || y0 < 0 || x0 + kSide >= other.cols || y0 + kSide >= other.rows) return {};
  const int u = cvRound((moved.x - left) * kWeights);
  const int v = cvRound((moved.y - top) * kWeights);
  // Weights of a pixel and its right neighbour, in pairs; then of the pair below.
  const cv::v_int16x8 above = pairs((kWeights - u) * (kWeights - v), u * (kWeights - v));
  const cv::v_int16x8 under = pairs((kWeights - u) * v, u * v);
  constexpr int kShift = 2 * kWeightBits - kScaleBits;
  const cv::v_int16x8 ones = cv::v_setall_s16(1);
  Sum d1, dx, dy;
  double dd = 0.0;
  for (int y = 0; y < kSide; ++y) {
    Sum squares;  // one row's sum, which fits 32 bits
    for (int x = 0; x < kSide; x += kLanes) {
      const auto* const row = other.ptr<std::uint8_t>(y0 + y) + x0 + x;
      const auto* const below = other.ptr<std::uint8_t>(y0 + y + 1) + x0 + x;
      cv::v_int16x8 rowLow, rowHigh, belowLow, belowHigh;
      cv::v_zip(eight(row), eight(row + 1), rowLow, rowHigh);
      cv::v_zip(eight(below), eight(below + 1), belowLow, belowHigh);
      const cv::v_int32x4 low = cv::v_dotprod(belowLow, under, cv::v_dotprod(rowLow, above));
      const cv::v_int32x4 high = cv::v_dotprod(belowHigh, under, cv::v_dotprod(rowHigh, above));
      const cv::v_int16x8 level = cv::v_load(&levels_[y][x]);
      const cv::v_int16x8 difference = cv::v_rshr_pack<kShift>(low, high) - (level << kScaleBits);
      d1.add(difference, ones);
      dx.add(difference, cv::v_load(&gradientX_[y][x]));
      dy.add(difference, cv::v_load(&gradientY_[y][x]));
      squares.add(difference, difference);
    }
    dd += squares.get();
  }
  constexpr double kPixels = kSide * kSide;
  const double sum = d1.get();
  return {.x = dx.get() - meanX_ * sum,
          .y = dy.get() - meanY_ * sum,
          .variance = std::max(0.0, dd - sum * sum / kPixels) / ((kPixels - 1.0) * kScale * kScale),
          .brightness = sum / (kPixels * kScale),
          .isInside = true};
}

template <int kSide>
PatchMatch SearchPatch<kSide>::at(const cv::Mat& other, const glm::dvec2& moved) const {
  const Sums sums = compare(other, moved);
  return {.moved = moved,
          .variance = sums.variance,
          .brightness = sums.brightness,
          .isInside = sums.isInside};
}

template <int kSide>
PatchMatch SearchPatch<kSide>::refined(const cv::Mat& other, const PatchMatch& guess, double noise,
                                       double guessPx) const {
  // Weight of the guess: as much as differences of the noise's size say about a shift this large.
  // The gradients are twice too large.
  const double hold = 4.0 * 2.0 * noise * noise / (guessPx * guessPx);
  const double xx = xx_ + hold;
  const double yy = yy_ + hold;
  const double determinant = xx * yy - xy_ * xy_;
  if (!(determinant > 0.0)) return guess;
  glm::dvec2 moved = guess.moved;
  Sums sums = compare(other, moved);
  for (int step = 0; step < kSteps && sums.isInside; ++step) {
    constexpr double kUnits = 2.0 / kScale;  // units of squared gradients, over those of the sums
    const glm::dvec2 right = kUnits * glm::dvec2(sums.x, sums.y) + hold * (moved - guess.moved);
    const glm::dvec2 change(-(yy * right.x - xy_ * right.y) / determinant,
                            -(xx * right.y - xy_ * right.x) / determinant);
    moved += change;
    const glm::dvec2 away = moved - guess.moved;
    if (!(glm::dot(away, away) < kDivergedPx * kDivergedPx)) return guess;
    sums = compare(other, moved);
    if (glm::dot(change, change) < kConvergedPx * kConvergedPx) break;
  }
  if (!sums.isInside || sums.variance > guess.variance) return guess;
  return {
      .moved = moved, .variance = sums.variance, .brightness = sums.brightness, .isInside = true};
}

template class SearchPatch<8>;
template class SearchPatch<16>;

}  // namespace pleinair::tracking
