#pragma once

#include <memory>

#include "hal/image.h"
#include "pipeline/tracking/motion/image_motion.h"

namespace pleinair::tracking {

/// Measures the motion of the whole camera image as a turn, zoom and shift. It moves textures that
/// go with the image but stay flat, such as the paper's grain (Cunzi et al., "Dynamic canvas for
/// immersive non-photorealistic walkthroughs", 2003).
///
/// Points of a key frame are followed into each frame (pyramidal Lucas-Kanade), and a similarity is
/// fitted to them without outliers. Motion is measured from the key frame and not from frame to
/// frame, so that nothing drifts; motion below a third of a pixel counts as rest. One thread at a
/// time.
class CanvasMotion {
 public:
  CanvasMotion();
  ~CanvasMotion();
  CanvasMotion(const CanvasMotion&) = delete;
  CanvasMotion& operator=(const CanvasMotion&) = delete;
  CanvasMotion(CanvasMotion&&) = delete;
  CanvasMotion& operator=(CanvasMotion&&) = delete;

  /// Takes the next frame's luma. The result maps px of this frame to px of the first frame since
  /// the last reset, pixel centres at +0.5. It does not change where nothing can be followed (a
  /// cut, a blank wall, another size).
  const PlaneSimilarity& follow(const hal::PlaneView& luma, hal::FrameSize size);

  /// Takes the next frame's motion from an ImageMotionEstimator instead, at no further cost: the
  /// similarity nearest to its homography. The canvas drifts no more than that homography, and
  /// rests when the motion reports rest.
  const PlaneSimilarity& follow(const ImageMotion& motion);

  /// Treats the next frame as the first one.
  void reset();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pleinair::tracking
