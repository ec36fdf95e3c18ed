#pragma once

#include <cstddef>

#include <glm/vec2.hpp>

#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/marks/focus_field.h"
#include "pipeline/marks/movers/layer_textures.h"
#include "pipeline/marks/movers/motion_layers.h"
#include "pipeline/marks/tensors/tensor_field.h"
#include "pipeline/scene/render/ar_frame.h"

namespace pleinair::styles {

/// Draws the inner pictures that are no strokes (painterlyViews()), over the camera's picture. Each
/// call fills the whole target, which has the frame's size. All calls on the thread of the GL
/// context that was current at construction.
class ViewDrawing {
 public:
  /// The library holds gpu::painterlyShaders().
  explicit ViewDrawing(const gpu::ShaderLibrary& library);

  /// "tensors" to "focus". `bands`: the detail from which the middle and the fine layer paint.
  void showField(const scene::ArFrame& frame, const marks::TensorField& field,
                 const marks::FocusField& focus, glm::vec2 bands, std::size_t view,
                 const gpu::RenderTarget& target);
  /// "movers" and "background". Null: movers are not told apart.
  void showMovers(const scene::ArFrame& frame, const marks::MotionLayers* movers, std::size_t view,
                  const gpu::RenderTarget& target);
  /// Null: strokes are clipped nowhere.
  void showSegments(const scene::ArFrame& frame, const gpu::Texture* borders,
                    const gpu::RenderTarget& target);
  void showFeatures(const scene::ArFrame& frame, const gpu::RenderTarget& target);
  /// Once the strokes are painted.
  void showHeight(const gpu::Texture& heights, const gpu::RenderTarget& target);

 private:
  gpu::Program field_;
  gpu::Program movers_;
  gpu::Program segments_;
  gpu::Program features_;
  gpu::Program height_;
  gpu::Texture noBorders_;
  gpu::Texture featurePlaces_;  // where each was, and where it is
  marks::LayerTextures layerTextures_;
};

}  // namespace pleinair::styles
