#pragma once

#include "pipeline/gpu/program.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/shader_library.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/marks/layer_textures.h"
#include "pipeline/marks/motion_layers.h"
#include "pipeline/scene/render/ar_frame.h"

namespace pleinair::styles {

/// Draws the borders at which strokes are clipped (shaders/borders.frag): those of objects, of
/// their patches and of movers. All calls on the thread of the GL context it was made in.
class StrokeBorders {
 public:
  /// `library` has gpu::strokesShaders(), marksShaders() and sceneShaders().
  explicit StrokeBorders(const gpu::ShaderLibrary& library);

  /// Draws the borders of a frame; without `movers` there are none of movers. `target` has one
  /// R32UI texture of the frame's size.
  void draw(const scene::ArFrame& frame, const marks::MotionLayers* movers,
            const gpu::RenderTarget& target);

 private:
  gpu::Program program_;
  gpu::Texture noForms_;
  marks::LayerTextures layerTextures_;
};

}  // namespace pleinair::styles
