#pragma once

#include <array>
#include <optional>

#include <opencv2/core.hpp>

namespace pleinair::measure {

/// Of the four samples around a point that is `t` past the second: cubic convolution (Keys, 1981)
/// with a = −0.5, which passes quadratics exactly.
inline std::array<float, 4> cubicWeights(float t) {
  return {((-0.5F * t + 1.0F) * t - 0.5F) * t, (1.5F * t - 2.5F) * t * t + 1.0F,
          ((-1.5F * t + 2.0F) * t + 0.5F) * t, (0.5F * t - 0.5F) * t * t};
}

/// Where what is at each pixel of a frame is in a later one, px.
struct MotionMap {
  /// The same whole number of pixels everywhere: then nothing has to be interpolated, and the
  /// fields below are empty.
  std::optional<cv::Point> shift;
  cv::Mat2f displacement;
  cv::Mat1b valid;  ///< 255 where it is known, seen in both frames, and at no motion boundary
};

/// A map that is `displacement` everywhere, which is a shift where it is a whole number.
MotionMap constantMap(cv::Size frame, cv::Point2d displacement);

/// A map of a measured or computed field: what is not `seen`, and what is near it or near a place
/// where the motion leaps by more than `leapPixels` from pixel to pixel, is not valid.
MotionMap fieldMap(cv::Mat2f displacement, const cv::Mat1b& seen, float leapPixels);

/// The displacement at a point, interpolated; nothing where it is not known.
std::optional<cv::Point2f> displacementAt(const MotionMap& map, cv::Point2f at);

/// A later picture as it was in the earlier frame.
template <class Picture>
struct Carried {
  Picture picture;
  cv::Mat1b mask;  ///< 255 where it says something: within the border, valid, inside both frames
};

/// The picture at x + displacement(x) + offset for each x: copied where the map is a shift, else
/// interpolated by cubic convolution (Keys, 1981, a = −0.5), which loses little. `reachPixels`:
/// how far around itself each pixel of the picture has looked, so that what looked across a motion
/// boundary does not count.
Carried<cv::Mat3f> carriedBack(const cv::Mat3f& later, const MotionMap& map, cv::Point offset = {},
                               int reachPixels = 0);
Carried<cv::Mat1f> carriedBack(const cv::Mat1f& later, const MotionMap& map, cv::Point offset = {},
                               int reachPixels = 0);

}  // namespace pleinair::measure
