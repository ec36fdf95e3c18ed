#pragma once

#include "pipeline/tracking/motion/image_motion.h"

namespace pleinair::tracking {

/// Measures the motion of the whole camera image as a turn, zoom and shift. It moves textures that
/// go with the image but stay flat, such as the paper's grain (Cunzi et al., "Dynamic canvas for
/// immersive non-photorealistic walkthroughs", 2003).
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

  /// Treats the next frame as the first one.
  void reset();

 private:
  PlaneSimilarity firstFromFrame_;
  PlaneSimilarity firstFromSeen_;  // with what is too little to be followed yet
};

}  // namespace pleinair::tracking
