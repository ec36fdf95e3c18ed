#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <opencv2/core.hpp>

#include "hal/image.h"
#include "pipeline/measure/input/true_motion.h"

namespace pleinair::measure {

/// The motion of a photograph in front of the camera, from each frame to the next.
struct PhotographMotion {
  cv::Point2d pan;         ///< px
  double zoomPercent = 0;  ///< about the frame's centre; above 0: the camera moves in
  double rollDegrees = 0;  ///< about the frame's centre, clockwise on the screen
};

/// A photograph seen by a camera that pans, zooms and rolls. Each pixel of a frame is the mean over
/// its area of the photograph, interpolated by cubic convolution, so that frames differ by their
/// motion only, which is known exactly. The photograph is scaled down to fill the frames, never up;
/// beyond its edges it continues mirrored.
class MovedPhotograph {
 public:
  /// `frames`: number of frames to come, which determines the photograph's scale.
  MovedPhotograph(const hal::Image& rgb8, hal::FrameSize size, PhotographMotion motion,
                  std::uint64_t frames);

  cv::Mat3f frame(std::uint64_t index) const;
  std::unique_ptr<TrueMotion> motion() const;
  /// Whether frames reach beyond the photograph.
  bool isMirrored() const { return isMirrored_; }

 private:
  cv::Mat3f photograph_;  ///< scaled, at most two of its pixels per frame pixel
  hal::FrameSize size_;
  PhotographMotion motion_;
  cv::Matx33d photographFromFirst_;  ///< pixel centres at whole numbers
  double samplesPerPixel_ = 1;
  bool isMirrored_ = false;
};

/// Maps pixels of frame 0 to frame `index`.
cv::Matx33d frameFromFirst(const PhotographMotion& motion, hal::FrameSize size,
                           std::uint64_t index);

}  // namespace pleinair::measure
