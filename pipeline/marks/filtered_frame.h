#pragma once

#include <memory>
#include <vector>

#include "hal/clock.h"
#include "pipeline/gpu/program.h"
#include "pipeline/gpu/shader_library.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/scene/render/ar_frame.h"

namespace pleinair::marks {

/// What FilteredFrame goes by beside the AR frame.
struct FilteredFrameInput {
  /// MotionField::backward(): where what is seen of the camera's picture has come from.
  const gpu::Texture* backward = nullptr;
  bool isCut = false;  ///< MotionField::isCut(): the past is of no use
  double timeConstantSeconds = 0.3;
  double noiseLevels = 2.0;  ///< of the camera, one standard deviation, in 1/255
};

/// The AR frame's colour averaged over time along the motion of what it shows, so that what is
/// decided of it (edges, thresholds) does not tremble with the sensor's noise: a picture without
/// noise, not a slower one.
///
/// The past is fetched from where the pixel's content was (ArFrame::motion where an object is seen,
/// else `backward`; Catmull-Rom, so that it is not blurred by being moved) and counts by how long
/// it has been averaged (a normalised exponential mean: frames after a first one count alike). It
/// is bounded to the range of the colours around the pixel now, widened by the noise (variance
/// clipping: Salvi, "An excursion in temporal supersampling", 2016; Karis, "High quality temporal
/// supersampling", 2014), and does not count at all where its place is unknown or outside, where
/// models come or go, at a cut, in the first frame, after reset(), and at another level of quality,
/// whose detail it has not. With a time constant of 0 the picture is the frame's.
///
/// All calls on the thread of the GL context it was made in.
class FilteredFrame {
 public:
  /// `library` has gpu::marksShaders() and gpu::sceneShaders().
  explicit FilteredFrame(const gpu::ShaderLibrary& library);

  /// Takes the next frame in. A frame whose time is not after the last one's adds to the mean as if
  /// no time had passed. Throws hal::Failure where the GPU has no memory for a new size.
  void update(const scene::ArFrame& frame, const FilteredFrameInput& input);

  /// RGBA16F, LINEAR, the frame's size: sRGB-coded colour; A: how many frames' worth of colours
  /// there are in it (1: this one alone), below 0 where a virtual object is seen. Valid until the
  /// next update(). Precondition: there was one.
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
  gpu::Texture noMotion_;  // stands where a frame has no texture for a sampler
  std::vector<std::unique_ptr<Canvas>> canvases_;  // of each size that was seen
  const gpu::Texture* now_ = nullptr;
  hal::FrameSize full_;
  hal::TimePoint lastTime_;
  bool hasPast_ = false;
};

}  // namespace pleinair::marks
