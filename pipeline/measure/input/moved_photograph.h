#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <opencv2/core.hpp>

#include "hal/image.h"
#include "pipeline/measure/input/true_motion.h"

namespace pleinair::measure {

/// How a photograph is moved before the camera, from each frame to the next.
struct PhotographMotion {
  cv::Point2d pan;         ///< px
  double zoomPercent = 0;  ///< about the frame's middle; above 0: the camera moves in
  double rollDegrees = 0;  ///< about the frame's middle, clockwise on the screen
};

/// A photograph as a camera sees it that pans, zooms and rolls: each frame is a sensor's, every
/// pixel the mean over its square of the photograph interpolated by cubic convolution, so that
/// frames differ by their motion, which is known exactly, and by nothing else. The photograph is
/// scaled down to fill the frames, never up; where a frame reaches beyond it, it goes on mirrored.
class MovedPhotograph {
 public:
  /// `frames`: how many there will be, which the photograph is scaled for.
  MovedPhotograph(const hal::Image& rgb8, hal::FrameSize size, PhotographMotion motion,
                  std::uint64_t frames);

  cv::Mat3f frame(std::uint64_t index) const;
  std::unique_ptr<TrueMotion> motion() const;
  /// Whether frames reach beyond the photograph.
  bool isMirrored() const { return isMirrored_; }

 private:
  cv::Mat3f photograph_;  ///< at its scale, two of its pixels a frame's at the most
  hal::FrameSize size_;
  PhotographMotion motion_;
  cv::Matx33d photographFromFirst_;  ///< pixel centres at whole numbers
  double samplesPerPixel_ = 1;
  bool isMirrored_ = false;
};

/// Pixels of frame 0 to frame `index`.
cv::Matx33d frameFromFirst(const PhotographMotion& motion, hal::FrameSize size,
                           std::uint64_t index);

}  // namespace pleinair::measure
