#include "pipeline/tracking/patch_flow.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace pleinair::tracking {
namespace {

constexpr int kSide = FlowPatch::kSide;
constexpr int kPixels = kSide * kSide;
constexpr int kScale = 16;    // of levels
constexpr int kWeights = 64;  // of a pixel by its neighbours, along an axis
constexpr int kSteps = 3;
constexpr double kEnoughPx = 0.02;  // a smaller step is the last
constexpr double kFarPx = 2.0;      // from the guess: it has gone astray
constexpr double kGuessPx = 0.3;    // how good guesses are

}  // namespace

FlowPatch::FlowPatch(const cv::Mat& picture, const cv::Point& middle)
    : corner_(middle - cv::Point(kSide / 2, kSide / 2)) {
  int x1 = 0;
  int y1 = 0;
  int xx = 0;
  int xy = 0;
  int yy = 0;
  for (int y = 0; y < kSide; ++y) {
    const auto* const above = picture.ptr<std::uint8_t>(corner_.y + y - 1) + corner_.x;
    const auto* const row = picture.ptr<std::uint8_t>(corner_.y + y) + corner_.x;
    const auto* const below = picture.ptr<std::uint8_t>(corner_.y + y + 1) + corner_.x;
    for (int x = 0; x < kSide; ++x) {
      const int gx = row[x + 1] - row[x - 1];
      const int gy = below[x] - above[x];
      levels_[y][x] = static_cast<short>(kScale * row[x]);
      gradientX_[y][x] = static_cast<short>(gx);
      gradientY_[y][x] = static_cast<short>(gy);
      x1 += gx;
      y1 += gy;
      xx += gx * gx;
      xy += gx * gy;
      yy += gy * gy;
    }
  }
  sumX_ = x1;
  sumY_ = y1;
  xx_ = xx - sumX_ * sumX_ / kPixels;
  xy_ = xy - sumX_ * sumY_ / kPixels;
  yy_ = yy - sumY_ * sumY_ / kPixels;
}

FlowPatch::Sums FlowPatch::compare(const cv::Mat& other, const glm::dvec2& moved) const {
  const double left = std::floor(moved.x);
  const double top = std::floor(moved.y);
  const int x0 = corner_.x + static_cast<int>(left);
  const int y0 = corner_.y + static_cast<int>(top);
  if (x0 < 0 || y0 < 0 || x0 + kSide >= other.cols || y0 + kSide >= other.rows) return {};
  const int u = static_cast<int>(std::lround((moved.x - left) * kWeights));
  const int v = static_cast<int>(std::lround((moved.y - top) * kWeights));
  const int w00 = (kWeights - u) * (kWeights - v);
  const int w10 = u * (kWeights - v);
  const int w01 = (kWeights - u) * v;
  const int w11 = u * v;
  constexpr int kShift = 8;  // kWeights² over kScale
  int d1 = 0;
  int dx = 0;
  int dy = 0;
  int dd = 0;
  for (int y = 0; y < kSide; ++y) {
    const auto* const row = other.ptr<std::uint8_t>(y0 + y) + x0;
    const auto* const below = other.ptr<std::uint8_t>(y0 + y + 1) + x0;
    alignas(16) short difference[kSide];
    for (int x = 0; x < kSide; ++x) {
      const int level = w00 * row[x] + w10 * row[x + 1] + w01 * below[x] + w11 * below[x + 1];
      difference[x] = static_cast<short>(((level + (1 << (kShift - 1))) >> kShift) - levels_[y][x]);
    }
    for (int x = 0; x < kSide; ++x) d1 += difference[x];
    for (int x = 0; x < kSide; ++x) dx += difference[x] * gradientX_[y][x];
    for (int x = 0; x < kSide; ++x) dy += difference[x] * gradientY_[y][x];
    for (int x = 0; x < kSide; ++x) dd += difference[x] * difference[x];
  }
  const double mean = static_cast<double>(d1) / kPixels;
  return {.x = dx - mean * sumX_,
          .y = dy - mean * sumY_,
          .variance = (dd - mean * d1) / (static_cast<double>(kPixels - 1) * kScale * kScale),
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
    if (!(std::hypot(away.x, away.y) < kFarPx)) return guess;
    sums = compare(other, moved);
    if (std::hypot(change.x, change.y) < kEnoughPx) break;
  }
  if (!sums.isInside || sums.variance > guess.variance) return guess;
  PatchMatch out = guess;
  out.moved = moved;
  out.variance = sums.variance;
  return out;
}

}  // namespace pleinair::tracking
