#pragma once

#include <cstddef>
#include <memory>

#include "hal/clock.h"
#include "hal/pixel_format.h"
#include "pipeline/gpu/shader_library.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/marks/motion_field.h"
#include "pipeline/scene/render/ar_frame.h"

namespace pleinair::marks {

struct TensorFieldOptions {
  /// How much virtual surfaces' own form leads: the edge strength (gradient.frag's P) of one that
  /// is seen edge on.
  double form = 0.5;
  double fillSigma = 1.0;  ///< of the radial-basis filling, in regions
  hal::Duration memory = std::chrono::milliseconds(400);  ///< time constant; 0: each frame alone
  double slack = 0.15;  ///< a region's detail is held until it differs by more than this part
};

/// In which direction things in the picture lie: edges' directions as tensors, spread over where
/// there are none by a pyramid (thesis §4.2). A tensor is (cos 2θ, sin 2θ) times how much its
/// pixels agree, θ the gradient's direction: strokes run across it. The first frame, one after
/// reset() and one after a cut of the motion have no past. All calls on the thread of the GL
/// context it was made in.
class TensorField {
 public:
  /// `library` has gpu::marksShaders() and gpu::gpuShaders(). Pictures' full size is `full`. Throws
  /// hal::Failure where the GPU has no memory for it.
  TensorField(const gpu::ShaderLibrary& library, hal::FrameSize full);
  ~TensorField();
  TensorField(const TensorField&) = delete;
  TensorField& operator=(const TensorField&) = delete;
  TensorField(TensorField&&) = delete;
  TensorField& operator=(TensorField&&) = delete;

  /// Takes a frame's picture (RGBA8, of frame.size()), carrying what it knew along `motion`, which
  /// has been updated for the frame. Precondition: frame.full() is the constructor's size.
  void update(const scene::ArFrame& frame, const gpu::Texture& picture, const MotionField& motion,
              const TensorFieldOptions& options);

  std::size_t levelCount() const;
  /// RGBA16F, LINEAR: a level's tensors, looked up from there on: tensor, how sure this level
  /// itself is of it in [0, 1], and detail: the mean gradient in units of a strong edge's. Level 0
  /// has the finest regions; each further one's are twice as wide.
  const gpu::Texture& resolved(std::size_t level) const;
  /// The same before the look-up, as the pyramid has it.
  const gpu::Texture& filled(std::size_t level) const;
  /// Before the filling: regions that have edges.
  const gpu::Texture& regions() const;
  /// A region's side on a level, px of the full picture.
  double regionPixels(std::size_t level) const;

  /// Forgets the past.
  void reset();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pleinair::marks
