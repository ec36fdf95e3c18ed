#pragma once

#include "hal/clock.h"
#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/images/per_size.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/marks/movers/layer_textures.h"
#include "pipeline/marks/movers/motion_layers.h"
#include "pipeline/scene/render/ar_frame.h"

namespace pleinair::styles {

/// The luma of a frame, and the tone that lines render: smoothed, apart for the background and what
/// is before it, and lightened where the picture is dark. The lightening follows the background
/// within some seconds, and at a first frame or a cut at once. All calls on the thread of the GL
/// context that was current at construction.
class DrawingTone {
 public:
  /// `library` has gpu::hatchingShaders(), marksShaders(), sceneShaders() and gpuShaders().
  explicit DrawingTone(const gpu::ShaderLibrary& library);

  struct Inputs {
    const gpu::Texture* source = nullptr;         ///< the image that tones are taken from
    const marks::MotionLayers* movers = nullptr;  ///< null: nothing moves by itself
    bool isCut = false;                           ///< there is no past: a cut, or a first frame
    double lighten = 0.0;                         ///< HatchingParameters::lighten
  };
  void update(const scene::ArFrame& frame, const Inputs& inputs);

  /// R8, LINEAR, as large as the frame. Valid after update(), like the following.
  const gpu::Texture& luma() const { return now_->luma; }
  /// RGBA16F, LINEAR, of a quarter of the width: shaders/tone.frag's, lightened.
  const gpu::Texture& tone() const { return now_->tone; }

  /// Frees the textures of all sizes.
  void clear();

 private:
  /// The textures of one image size.
  struct Images {
    explicit Images(hal::FrameSize size);
    gpu::Texture luma;
    gpu::Texture halfTone;
    gpu::Texture tone;
    gpu::RenderTarget lumaTarget;
    gpu::RenderTarget halfToneTarget;
    gpu::RenderTarget toneTarget;
  };
  void findLightening(const scene::ArFrame& frame, bool isCut);

  gpu::Program luma_;
  gpu::Program first_;
  gpu::Program findLightening_;
  gpu::Program blur_;
  gpu::Texture noIds_;
  marks::LayerTextures layerTextures_;
  gpu::PerSize<Images> images_;
  Images* now_ = nullptr;
  gpu::Buffer lightening_;   // shaders/tone_lightening.comp's
  hal::TimePoint lastTime_;  // when it was found
};

}  // namespace pleinair::styles
