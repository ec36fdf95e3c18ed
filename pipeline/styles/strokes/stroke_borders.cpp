#include "pipeline/styles/strokes/stroke_borders.h"

namespace pleinair::styles {

StrokeBorders::StrokeBorders(const gpu::ShaderLibrary& library)
    : program_(library.fragmentPass("pipeline/styles/strokes/shaders/borders.frag", {},
                                    {gpu::TextureFormat::kR32ui})),
      noForms_(gpu::TextureFormat::kR32ui, {1, 1}) {}

void StrokeBorders::draw(const scene::ArFrame& frame, const marks::MotionLayers* movers,
                         const gpu::RenderTarget& target, const marks::SegmentMap* segments,
                         const gpu::Texture* before) {
  const hal::FrameSize size = frame.size();
  const bool hasDepth = frame.hasObjects && frame.depth != nullptr;
  marks::SegmentMap::bind(program_.use(), segments, noForms_);
  program_.texture("forms", frame.hasObjects ? *frame.forms : noForms_)
      .texture("depth", hasDepth ? *frame.depth : *frame.colour)
      .set("depthRange", hasDepth ? glm::vec2(frame.nearMetres, frame.farMetres) : glm::vec2(0.0F))
      .texture("moverShares", layerTextures_.sharesOf(movers))
      .texture("background", layerTextures_.backgroundOf(movers))
      .texture("picture", *frame.colour)
      .texture("before", before != nullptr ? *before : noForms_)
      .set("hasObjects", frame.hasObjects ? 1 : 0)
      .set("objectBounds", frame.objectBoundsOrAll())
      .set("isHeld", before != nullptr ? 1 : 0)
      .set("size", glm::vec2(size.width, size.height))
      .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()))
      .drawFullscreen(target);
}

}  // namespace pleinair::styles
