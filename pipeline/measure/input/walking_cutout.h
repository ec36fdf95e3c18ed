#pragma once

#include <filesystem>
#include <memory>

#include <opencv2/core.hpp>

#include "hal/clock.h"
#include "hal/image.h"
#include "pipeline/measure/input/true_motion.h"

namespace pleinair::measure {

/// A cutout that walks past a photograph, and how fast.
struct WalkerOptions {
  std::filesystem::path cutout;  ///< a picture with transparency
  double pixelsPerSecond = 180.0;
};

/// A thing cut out of a photograph that walks past a standing camera, from the left to the right:
/// it comes in after a second, sways about its foot and bobs as people do, and has gone for more
/// than a second at the end. Eight tenths of the frame's height are its own, and its lower edge is
/// below the frame's. Times are since the first frame.
class WalkingCutout {
 public:
  /// Precondition: the image is RGBA8, its alpha not premultiplied, and a pixel of it is opaque;
  /// the speed is above 0.
  WalkingCutout(const hal::Image& rgba8, hal::FrameSize frame, double pixelsPerSecond);

  /// Whether there is anything to see of a cutout: a pixel that is more opaque than not.
  static bool isSeen(const hal::Image& rgba8);

  /// Draws it over RGB in [0, 1]; each pixel is the mean over its area.
  void drawInto(cv::Mat3f& picture, hal::Duration at) const;
  /// 255 where it is more opaque than not, else 0.
  cv::Mat1b mask(hal::Duration at) const;
  /// Maps pixels of the frame at one time to another's, on the cutout (centres at whole numbers).
  cv::Matx33d displacement(hal::Duration from, hal::Duration to) const;
  /// How long all of it takes.
  hal::Duration duration() const;

 private:
  cv::Matx33d frameFromCutout(hal::Duration at) const;
  cv::Mat4f drawn(hal::Duration at) const;

  cv::Mat4f cutout_;  ///< premultiplied, cropped to what is seen, about two of its px per frame px
  cv::Size frame_;
  double scale_;  ///< frame px per px of the cutout
  double pixelsPerSecond_;
};

/// The true motion and masks of frames before a standing camera that a cutout walks past. `walker`
/// must outlive them; `period`: between frames.
std::unique_ptr<TrueMotion> walkerMotion(const WalkingCutout& walker, cv::Size frame,
                                         hal::Duration period);
std::unique_ptr<TrueMovers> walkerMovers(const WalkingCutout& walker, hal::Duration period);

}  // namespace pleinair::measure
