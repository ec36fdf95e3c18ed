#pragma once

#include <memory>
#include <vector>

#include "hal/clock.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/scene/render/ar_frame.h"

namespace pleinair::marks {

/// The inputs of FilteredFrame besides the AR frame.
struct FilteredFrameInput {
  /// MotionField::backward(): the motion of the camera image since the previous frame.
  const gpu::Texture* backward = nullptr;
  bool isCut = false;  ///< MotionField::isCut(): the past cannot be used
  double timeConstantSeconds = 0.3;
  double noiseLevels = 2.0;  ///< the camera's noise, one standard deviation, in 1/255
};

/// The AR frame's colour, averaged over time along the motion of the image content, so that edges
/// and thresholds do not flicker with sensor noise. The filter removes noise and adds no lag.
///
/// Each pixel fetches its past from the place where its content was (ArFrame::motion on objects,
/// else `backward`; with Catmull-Rom, so that motion does not blur). The past is weighted by the
/// number of frames in it (a normalised exponential mean: the frames after a first one have equal
/// weights) and clamped to the range of the current colours around the pixel, widened by the noise
/// (variance clipping: Salvi, "An excursion in temporal supersampling", 2016; Karis, "High quality
/// temporal supersampling", 2014). The past is rejected where its place is unknown or outside the
/// image, where models appear or disappear, at a cut, in the first frame, after reset(), and after
/// a change of quality level, whose detail it lacks. With a time constant of 0 the output is the
/// frame's colour.
///
/// All calls on the thread of the GL context that was current at construction.
class FilteredFrame {
 public:
  /// `library` has gpu::marksShaders() and gpu::sceneShaders().
  explicit FilteredFrame(const gpu::ShaderLibrary& library);

  /// Adds the next frame. A frame whose time is not after the previous one's is added as if no time
  /// had passed. Throws hal::Failure if GPU memory for a new size runs out.
  void update(const scene::ArFrame& frame, const FilteredFrameInput& input);

  /// RGBA16F, LINEAR, the frame's size: sRGB-coded colour. A: the number of frames in the mean (1:
  /// this one alone), below 0 on virtual objects. Valid until the next update(). Precondition:
  /// update() was called.
  const gpu::Texture& picture() const { return *now_; }

  /// Forgets the past.
  void reset();

 private:
  struct Canvas {
    explicit Canvas(hal::FrameSize size);
    hal::FrameSize size;
    gpu::Texture pictures[2];
  };

  Canvas& canvasOf(hal::FrameSize size);

  gpu::Program average_;
  gpu::Program averageObjects_;
  gpu::Texture noMotion_;                          // bound in place of a texture that a frame lacks
  std::vector<std::unique_ptr<Canvas>> canvases_;  // one for each size so far
  const gpu::Texture* now_ = nullptr;
  hal::FrameSize full_;
  hal::TimePoint lastTime_;
  bool hasPast_ = false;
};

}  // namespace pleinair::marks
