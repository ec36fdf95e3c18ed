#pragma once

#include <cstdint>
#include <memory>

#include "hal/image.h"
#include "pipeline/tracking/image/luma.h"
#include "pipeline/tracking/motion/feature_tracker.h"
#include "pipeline/tracking/motion/image_motion.h"

namespace pleinair::tracking {

struct ImageMotionOptions {
  FeatureMethod features = FeatureMethod::kLucasKanade;
  bool flow = true;           ///< estimates dense flow
  bool staticRegions = true;  ///< detects static regions
  /// The camera is fixed to something that does not move: only where nearly all of the image moves
  /// as one, it moves. Else the image's dominant motion may be that of something large before a
  /// plain wall, which the image cannot tell.
  bool isMounted = false;
};

/// Measures the motion of a camera image in the image alone: features, the dominant motion, dense
/// flow and static regions. Measures in an image of at most 640 px; motion within sensor noise is
/// reported as exactly zero. Keeps its buffers from frame to frame; in steady state only OpenCV
/// allocates. One thread at a time; uses OpenCV's threads.
class ImageMotionEstimator {
 public:
  explicit ImageMotionEstimator(ImageMotionOptions options = {});
  ~ImageMotionEstimator();
  ImageMotionEstimator(const ImageMotionEstimator&) = delete;
  ImageMotionEstimator& operator=(const ImageMotionEstimator&) = delete;
  ImageMotionEstimator(ImageMotionEstimator&&) = delete;
  ImageMotionEstimator& operator=(ImageMotionEstimator&&) = delete;

  /// Takes the next frame and returns its motion since the previous one, valid until the next call.
  /// The first frame, and one of another size, is a cut. Frames without contrast (a covered lens, a
  /// flash) are no cut at first, since the earlier scene may come back.
  const ImageMotion& follow(LumaFrame& frame, std::uint64_t sequence);
  /// Takes a frame that is luma already, one byte per pixel.
  const ImageMotion& follow(const hal::PlaneView& luma, hal::FrameSize size,
                            std::uint64_t sequence);

  /// Treats the next frame as the first one.
  void reset();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pleinair::tracking
