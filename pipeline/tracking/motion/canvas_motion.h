#pragma once

#include <memory>

#include "hal/image.h"
#include "pipeline/tracking/motion/image_motion.h"

namespace pleinair::tracking {

/// How a camera's picture moves as a whole, as the turn, zoom and shift that most of it follows:
/// for what is to go with the picture and yet stay flat, such as the grain of the paper (Cunzi et
/// al., "Dynamic canvas for immersive non-photorealistic walkthroughs", 2003).
///
/// Points of a key frame are followed into each frame (pyramidal Lucas-Kanade) and a similarity is
/// fitted to them without outliers. All is measured from the key frame and not from frame to frame,
/// so that a camera that stands still stands still: movements under a third of a pixel are not
/// followed, and nothing drifts. One thread at a time.
class CanvasMotion {
 public:
  CanvasMotion();
  ~CanvasMotion();
  CanvasMotion(const CanvasMotion&) = delete;
  CanvasMotion& operator=(const CanvasMotion&) = delete;
  CanvasMotion(CanvasMotion&&) = delete;
  CanvasMotion& operator=(CanvasMotion&&) = delete;

  /// Takes the next frame's luma. What is returned takes px of this frame to those of the first one
  /// since the last reset, pixel centres at +0.5. Where nothing can be followed (a cut, a blank
  /// wall, another size) it stays as it was.
  const PlaneSimilarity& follow(const hal::PlaneView& luma, hal::FrameSize size);

  /// The same by what an ImageMotionEstimator has found of the next frame, which costs nothing
  /// more: the similarity that its homography is nearest to. Nothing drifts where that does not,
  /// and the picture holds still where it says so.
  const PlaneSimilarity& follow(const ImageMotion& motion);

  /// The next frame is a first one.
  void reset();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pleinair::tracking
