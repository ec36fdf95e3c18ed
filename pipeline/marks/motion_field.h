#pragma once

#include <cstdint>
#include <memory>

#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/scene/render/ar_frame.h"

namespace pleinair::marks {

struct MotionFieldOptions {
  /// if false, everything counts as static on the screen, models included; a cut stays a cut
  bool follows = true;
};

/// The motion of the camera image, on the GPU: homography, features, dense flow, static regions
/// (tracking::ImageMotion) and the scene's planes. Shaders can query single points
/// (shaders/image_motion.glsl) or read a dense field for warping whole images. Each query uses the
/// source with the smallest predicted error. All calls on the thread of the GL context that was
/// current at construction.
class MotionField {
 public:
  /// `library` has gpu::marksShaders() and gpu::sceneShaders(). `full` is the size of the full
  /// image. Throws hal::Failure if GPU memory runs out.
  MotionField(const gpu::ShaderLibrary& library, hal::FrameSize full);
  ~MotionField();
  MotionField(const MotionField&) = delete;
  MotionField& operator=(const MotionField&) = delete;
  MotionField(MotionField&&) = delete;
  MotionField& operator=(MotionField&&) = delete;

  /// Takes the motion of `frame` (ArFrame::measuredMotion, surfaces). A motion relative to any
  /// frame but the previous update's counts as a cut. Precondition: frame.full() is the
  /// constructor's size.
  void update(const scene::ArFrame& frame, const MotionFieldOptions& options = {});

  /// Whether the past is invalid: first frame, cut, or a motion relative to another frame.
  bool isCut() const;
  /// MotionFieldOptions::follows of the last update.
  bool follows() const;
  /// Whether the homography of the last update is exactly the identity.
  bool isStanding() const;
  /// The camera's noise: one standard deviation of a px's luma, in 1/255.
  double noiseLevels() const;

  /// The motion of the camera image as a field (on models, ArFrame::motion is more exact): RGBA16F,
  /// LINEAR; texel (i, j) is centred on a block of kFieldPixels² px of the full image. It holds the
  /// displacement since the previous frame (px of the full image, from there to here), the
  /// predicted error (px) and the MotionSource. The content at p was at p − displacement.
  const gpu::Texture& backward() const;
  static constexpr int kFieldPixels = 8;

  /// Binds the inputs of shaders/image_motion.glsl for forward queries: uniform blocks 1 to 3, two
  /// textures, and the camera. Preconditions: the program is in use; update() was called.
  void bind(gpu::Program& program) const;
  /// The same with the flow from this frame to the previous one.
  void bindBackward(gpu::Program& program) const;

  /// Forgets the previous frame.
  void reset();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pleinair::marks
