#pragma once

#include <array>
#include <optional>

#include <opencv2/core.hpp>

namespace pleinair::measure {

/// Weights of the four samples around a point that is `t` past the second: cubic convolution (Keys,
/// 1981) with a = −0.5, which reproduces quadratics exactly.
inline std::array<float, 4> cubicWeights(float t) {
  return {((-0.5F * t + 1.0F) * t - 0.5F) * t, (1.5F * t - 2.5F) * t * t + 1.0F,
          ((-1.5F * t + 2.0F) * t + 0.5F) * t, (0.5F * t - 0.5F) * t * t};
}

/// Displacement (px) of each pixel of a frame to its position in a later one.
struct MotionMap {
  /// Set if all pixels move by the same whole number of pixels: nothing is interpolated then, and
  /// the fields below are empty.
  std::optional<cv::Point> shift;
  cv::Mat2f displacement;
  cv::Mat1b valid;  ///< 255 where it is known, visible in both frames, and not at a motion boundary
};

/// A map with a constant displacement; it is a shift if the displacement is whole.
MotionMap constantMap(cv::Size frame, cv::Point2d displacement);

/// A map of a measured or computed field. Pixels are invalid where not `seen`, and close to such
/// pixels or to places where neighbouring displacements differ by more than `boundaryStepPixels`.
MotionMap fieldMap(cv::Mat2f displacement, const cv::Mat1b& seen, float boundaryStepPixels);

/// The same field, valid only in a region (255), and there only where a filter of `reachPixels`
/// radius has crossed no motion boundary. Precondition: it is no shift.
MotionMap limitedTo(const cv::Mat1b& region, const MotionMap& map, int reachPixels = 0);

/// The interpolated displacement at a point; nothing where it is unknown.
std::optional<cv::Point2f> displacementAt(const MotionMap& map, cv::Point2f at);

/// A later image warped back to the earlier frame.
template <class Picture>
struct Warped {
  Picture picture;
  cv::Mat1b mask;  ///< 255 where valid: within the border, with known motion, inside of both frames
};

/// The image at x + displacement(x) + offset for each x: copied where the map is a shift, otherwise
/// interpolated by cubic convolution (Keys, 1981, a = −0.5), which loses little. `reachPixels`:
/// radius of the filter that made the image; pixels whose filter crossed a motion boundary are
/// invalid.
Warped<cv::Mat3f> warpedBack(const cv::Mat3f& later, const MotionMap& map, cv::Point offset = {},
                             int reachPixels = 0);
Warped<cv::Mat1f> warpedBack(const cv::Mat1f& later, const MotionMap& map, cv::Point offset = {},
                             int reachPixels = 0);

}  // namespace pleinair::measure
