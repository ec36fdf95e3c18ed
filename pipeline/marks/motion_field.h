#pragma once

#include <cstdint>
#include <memory>

#include "pipeline/gpu/program.h"
#include "pipeline/gpu/shader_library.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/scene/render/ar_frame.h"

namespace pleinair::marks {

struct MotionFieldOptions {
  bool follows = true;  ///< else all is taken to rest on the screen, models too; a cut stays one
};

/// What is known of the motion of the camera's picture, on the GPU: homography, features, dense
/// flow, stillness (tracking::ImageMotion) and the scene's planes, for shaders that ask about
/// single points (shaders/image_motion.glsl), and as a field for those that carry whole pictures
/// along. At each place the source with the smallest predicted error is taken. All calls on the
/// thread of the GL context it was made in.
class MotionField {
 public:
  /// `library` has gpu::marksShaders() and gpu::sceneShaders(). Pictures' full size is `full`.
  /// Throws hal::Failure where the GPU has no memory for it.
  MotionField(const gpu::ShaderLibrary& library, hal::FrameSize full);
  ~MotionField();
  MotionField(const MotionField&) = delete;
  MotionField& operator=(const MotionField&) = delete;
  MotionField(MotionField&&) = delete;
  MotionField& operator=(MotionField&&) = delete;

  /// Takes what `frame` knows (ArFrame::measuredMotion, surfaces). A motion that refers to another
  /// frame than the last update's is refused: that is a cut. Precondition: frame.full() is the
  /// constructor's size.
  void update(const scene::ArFrame& frame, const MotionFieldOptions& options = {});

  /// Whether nothing of the past goes on: the first frame, a cut, a motion that was refused.
  bool isCut() const;
  /// The last update's MotionFieldOptions::follows.
  bool follows() const;

  /// The image's motion as a field, models not counted (where they are seen, ArFrame::motion says
  /// more): RGBA16F, LINEAR, texel (i, j) in the middle of kFieldPixels² px of the full picture:
  /// displacement since the frame before (px of the full picture; leads from where it was to here),
  /// its predicted error (px), MotionSource. What is at p was at p − displacement.
  const gpu::Texture& backward() const;
  static constexpr int kFieldPixels = 8;

  /// Binds what shaders/image_motion.glsl reads for questions forward in time: uniform blocks 1 to
  /// 3, two textures, and the camera. Preconditions: the program is in use; there was an update().
  void bind(gpu::Program& program) const;

  /// Forgets the frame before.
  void reset();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pleinair::marks
