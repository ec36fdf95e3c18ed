#pragma once

#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/marks/movers/layer_textures.h"
#include "pipeline/marks/movers/motion_layers.h"
#include "pipeline/marks/tensors/segment_map.h"
#include "pipeline/scene/render/ar_frame.h"

namespace pleinair::styles {

/// Draws the borders at which strokes are clipped (shaders/borders.glsl): those of objects, of
/// their patches, of movers and of segments of the camera image. All calls on the thread of the GL
/// context it was made in.
class StrokeBorders {
 public:
  /// `library` has gpu::strokesShaders(), marksShaders() and sceneShaders().
  explicit StrokeBorders(const gpu::ShaderLibrary& library);

  /// Draws the borders of a frame; without `movers` and `segments` there are none of these. Without
  /// segments, only the places where objects and movers may be are worked on. `target` has one
  /// R32UI texture of the frame's size; `before`: the previous frame's, to hold borders of segments
  /// to while the camera stands.
  void draw(const scene::ArFrame& frame, const marks::MotionLayers* movers,
            const gpu::RenderTarget& target, const marks::SegmentMap* segments = nullptr,
            const gpu::Texture* before = nullptr);

 private:
  /// Fills what borders.glsl reads, but for the previous frame's.
  gpu::Program& begin(gpu::Program& program, const scene::ArFrame& frame,
                      const marks::MotionLayers* movers, const marks::SegmentMap* segments) const;
  void drawSparse(const scene::ArFrame& frame, const marks::MotionLayers* movers,
                  const gpu::RenderTarget& target);

  gpu::Program all_;
  gpu::Program ofObjects_;  // of a part of the picture
  gpu::Program ofMovers_;
  gpu::Texture noForms_;
  marks::LayerTextures layerTextures_;
};

}  // namespace pleinair::styles
