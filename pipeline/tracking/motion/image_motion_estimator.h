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
  bool flow = true;           ///< dense flow, too
  bool staticRegions = true;  ///< and where nothing moves
};

/// Finds out how a camera's picture moves, in the picture alone: features, the motion that most of
/// it follows, dense flow, and where it stands still. Everything is measured in a picture of at
/// most 640 px, and what only trembles within sensor noise does not move at all. Keeps its buffers
/// from frame to frame; in steady state only OpenCV allocates. One thread at a time; OpenCV's own
/// threads help.
class ImageMotionEstimator {
 public:
  explicit ImageMotionEstimator(ImageMotionOptions options = {});
  ~ImageMotionEstimator();
  ImageMotionEstimator(const ImageMotionEstimator&) = delete;
  ImageMotionEstimator& operator=(const ImageMotionEstimator&) = delete;
  ImageMotionEstimator(ImageMotionEstimator&&) = delete;
  ImageMotionEstimator& operator=(ImageMotionEstimator&&) = delete;

  /// Takes the next frame's luma and says how it moved since the frame before; the
  /// first one, and one of another size, is a cut. What is returned is valid until the next call.
  /// Frames that show nothing at all (a covered lens, a flash) are no cut at first: what was seen
  /// before may come back.
  const ImageMotion& follow(LumaFrame& frame, std::uint64_t sequence);
  /// Likewise, of one byte a pixel.
  const ImageMotion& follow(const hal::PlaneView& luma, hal::FrameSize size,
                            std::uint64_t sequence);

  /// The next frame is a first one.
  void reset();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pleinair::tracking
