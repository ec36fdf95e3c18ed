#include "pipeline/measure/input/motion_map.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "pipeline/measure/input/picture.h"

namespace pleinair::measure {
namespace {

/// Distance from a motion boundary or a hidden area within which pixels are invalid: anti-aliased
/// edges and interpolation mix different motions there.
constexpr int kBoundaryPixels = 3;
constexpr double kWholeTolerance = 1e-6;

/// Erodes a mask by `pixels` px.
cv::Mat1b shrunk(const cv::Mat1b& mask, int pixels) {
  cv::Mat1b result;
  cv::erode(mask, result,
            cv::getStructuringElement(cv::MORPH_RECT, {2 * pixels + 1, 2 * pixels + 1}));
  return result;
}

/// The seen pixels without those at motion boundaries.
cv::Mat1b withoutBoundaries(const cv::Mat2f& displacement, const cv::Mat1b& seen,
                            float boundaryStepPixels) {
  cv::Mat1b kept = seen.clone();
  const auto isBoundary = [boundaryStepPixels](const cv::Vec2f& a, const cv::Vec2f& b) {
    return std::abs(a[0] - b[0]) > boundaryStepPixels || std::abs(a[1] - b[1]) > boundaryStepPixels;
  };
  for (int y = 0; y < displacement.rows; ++y) {
    for (int x = 0; x < displacement.cols; ++x) {
      const bool right =
          x + 1 < displacement.cols && isBoundary(displacement(y, x), displacement(y, x + 1));
      const bool below =
          y + 1 < displacement.rows && isBoundary(displacement(y, x), displacement(y + 1, x));
      if (right || below) kept(y, x) = 0;
    }
  }
  return kept;
}

template <class Picture>
using PixelOf = typename Picture::value_type;

template <class Picture>
PixelOf<Picture> cubicAt(const Picture& picture, cv::Point first, const std::array<float, 4>& wx,
                         const std::array<float, 4>& wy) {
  PixelOf<Picture> sum{};
  for (int row = 0; row < 4; ++row) {
    const PixelOf<Picture>* line = picture[first.y + row] + first.x;
    const PixelOf<Picture> along =
        line[0] * wx[0] + line[1] * wx[1] + line[2] * wx[2] + line[3] * wx[3];
    sum += along * wy[static_cast<std::size_t>(row)];
  }
  return sum;
}

template <class Picture>
Warped<Picture> shifted(const Picture& later, cv::Point by) {
  Warped<Picture> result{Picture(later.size(), PixelOf<Picture>{}), cv::Mat1b(later.size(), 0)};
  const cv::Rect frame({}, later.size());
  const cv::Rect to = frame & (frame - by);
  if (to.empty()) return result;
  later(to + by).copyTo(result.picture(to));
  const cv::Rect looked = to & innerRect(later.size());
  if (!looked.empty()) result.mask(looked).setTo(255);
  return result;
}

template <class Picture>
Warped<Picture> interpolated(const Picture& later, const MotionMap& map, cv::Point offset,
                             int reachPixels) {
  Warped<Picture> result{Picture(later.size(), PixelOf<Picture>{}), cv::Mat1b(later.size(), 0)};
  const cv::Mat1b valid = reachPixels > 0 ? shrunk(map.valid, reachPixels) : map.valid;
  const cv::Rect inner = innerRect(later.size());
  for (int y = inner.y; y < inner.br().y; ++y) {
    for (int x = inner.x; x < inner.br().x; ++x) {
      if (valid(y, x) == 0) continue;
      const cv::Vec2f& by = map.displacement(y, x);
      const float atX = static_cast<float>(x + offset.x) + by[0];
      const float atY = static_cast<float>(y + offset.y) + by[1];
      const cv::Point first(static_cast<int>(std::floor(atX)) - 1,
                            static_cast<int>(std::floor(atY)) - 1);
      if (first.x < 0 || first.y < 0 || first.x + 3 >= later.cols || first.y + 3 >= later.rows) {
        continue;
      }
      result.picture(y, x) =
          cubicAt(later, first, cubicWeights(atX - static_cast<float>(first.x + 1)),
                  cubicWeights(atY - static_cast<float>(first.y + 1)));
      result.mask(y, x) = 255;
    }
  }
  return result;
}

template <class Picture>
Warped<Picture> carried(const Picture& later, const MotionMap& map, cv::Point offset,
                        int reachPixels) {
  if (map.shift) return shifted(later, *map.shift + offset);
  return interpolated(later, map, offset, reachPixels);
}

}  // namespace

MotionMap constantMap(cv::Size frame, cv::Point2d displacement) {
  const cv::Point2d whole(std::round(displacement.x), std::round(displacement.y));
  const cv::Point2d rest = displacement - whole;
  if (std::abs(rest.x) < kWholeTolerance && std::abs(rest.y) < kWholeTolerance) {
    return {.shift = cv::Point(static_cast<int>(whole.x), static_cast<int>(whole.y)),
            .displacement = {},
            .valid = {}};
  }
  const cv::Vec2f everywhere(static_cast<float>(displacement.x),
                             static_cast<float>(displacement.y));
  return {
      .shift = {}, .displacement = cv::Mat2f(frame, everywhere), .valid = cv::Mat1b(frame, 255)};
}

MotionMap fieldMap(cv::Mat2f displacement, const cv::Mat1b& seen, float boundaryStepPixels) {
  const cv::Mat1b valid =
      shrunk(withoutBoundaries(displacement, seen, boundaryStepPixels), kBoundaryPixels);
  return {.shift = {}, .displacement = std::move(displacement), .valid = valid};
}

MotionMap limitedTo(const cv::Mat1b& region, const MotionMap& map, int reachPixels) {
  assert(!map.shift);
  cv::Mat1b valid;
  cv::bitwise_and(reachPixels > 0 ? shrunk(map.valid, reachPixels) : map.valid, region, valid);
  return {.shift = {}, .displacement = map.displacement, .valid = valid};
}

std::optional<cv::Point2f> displacementAt(const MotionMap& map, cv::Point2f at) {
  if (map.shift) return cv::Point2f(*map.shift);
  const int x = static_cast<int>(std::floor(at.x));
  const int y = static_cast<int>(std::floor(at.y));
  if (x < 0 || y < 0 || x + 1 >= map.valid.cols || y + 1 >= map.valid.rows) return std::nullopt;
  const cv::Rect around(x, y, 2, 2);
  if (cv::countNonZero(map.valid(around)) < 4) return std::nullopt;
  const float tx = at.x - static_cast<float>(x);
  const float ty = at.y - static_cast<float>(y);
  const cv::Mat2f& by = map.displacement;
  const cv::Vec2f above = by(y, x) * (1 - tx) + by(y, x + 1) * tx;
  const cv::Vec2f below = by(y + 1, x) * (1 - tx) + by(y + 1, x + 1) * tx;
  const cv::Vec2f mixed = above * (1 - ty) + below * ty;
  return cv::Point2f(mixed[0], mixed[1]);
}

Warped<cv::Mat3f> warpedBack(const cv::Mat3f& later, const MotionMap& map, cv::Point offset,
                             int reachPixels) {
  return carried(later, map, offset, reachPixels);
}

Warped<cv::Mat1f> warpedBack(const cv::Mat1f& later, const MotionMap& map, cv::Point offset,
                             int reachPixels) {
  return carried(later, map, offset, reachPixels);
}

}  // namespace pleinair::measure
