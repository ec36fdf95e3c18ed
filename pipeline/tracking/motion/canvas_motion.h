#pragma once

#include "pipeline/tracking/motion/image_motion.h"

namespace pleinair::tracking {

/// How a camera's picture moves as a whole, as the turn, zoom and shift that most of it follows:
/// for what is to go with the picture and yet stay flat, such as the grain of the paper (Cunzi et
/// al., "Dynamic canvas for immersive non-photorealistic walkthroughs", 2003).
///
/// The motion is the similarity nearest to the homography that an ImageMotionEstimator finds, which
/// measures from key frames: nothing drifts where that does not. Movements under a third of a pixel
/// add up unseen until they reach it, so that a camera that stands still stands still. One thread
/// at a time.
class CanvasMotion {
 public:
  /// Takes the next frame's motion. What is returned takes px of this frame to those of the first
  /// one since the last reset, pixel centres at +0.5. Where nothing can be followed (a cut, a blank
  /// wall, another size) it stays as it was.
  const PlaneSimilarity& follow(const ImageMotion& motion);

  /// The next frame is a first one.
  void reset();

 private:
  PlaneSimilarity firstFromFrame_;
  PlaneSimilarity firstFromSeen_;  // with what is too little to be followed yet
};

}  // namespace pleinair::tracking
