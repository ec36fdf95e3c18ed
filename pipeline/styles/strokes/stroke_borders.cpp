#include "pipeline/styles/strokes/stroke_borders.h"

namespace pleinair::styles {

StrokeBorders::StrokeBorders(const gpu::ShaderLibrary& library)
    : program_(library.fragmentPass("pipeline/styles/strokes/shaders/borders.frag")),
      noForms_(gpu::TextureFormat::kR32ui, {1, 1}) {}

void StrokeBorders::draw(const scene::ArFrame& frame, const marks::MotionLayers* movers,
                         const gpu::RenderTarget& target) {
  const hal::FrameSize size = frame.size();
  program_.use()
      .texture("forms", frame.hasObjects ? *frame.forms : noForms_)
      .texture("movers", layerTextures_.labelsOf(movers))
      .set("hasObjects", frame.hasObjects ? 1 : 0)
      .set("size", glm::vec2(size.width, size.height))
      .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()))
      .drawFullscreen(target);
}

}  // namespace pleinair::styles
