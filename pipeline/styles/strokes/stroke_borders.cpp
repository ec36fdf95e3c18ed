#include "pipeline/styles/strokes/stroke_borders.h"

#include <array>
#include <string>

namespace pleinair::styles {
namespace {

const std::string kShaders = "pipeline/styles/strokes/shaders/";
constexpr std::array kFormats{gpu::TextureFormat::kR32ui};
/// A pixel without a border (pipeline/marks/strokes/shaders/stroke_border.glsl): of label 0, all of
/// it.
constexpr unsigned kNoBorder = 31U << 26U;

/// Fills what borders.glsl reads in both of its programs.
void bindMovers(gpu::Program& program, const scene::ArFrame& frame,
                const marks::MotionLayers* movers, const marks::LayerTextures& layerTextures) {
  const hal::FrameSize size = frame.size();
  program.texture("moverShares", layerTextures.sharesOf(movers))
      .texture("background", layerTextures.backgroundOf(movers))
      .texture("picture", *frame.colour)
      .set("size", glm::vec2(size.width, size.height))
      .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()));
}

}  // namespace

StrokeBorders::StrokeBorders(const gpu::ShaderLibrary& library)
    : all_(library.fragmentPass(kShaders + "borders.frag", {}, {gpu::TextureFormat::kR32ui})),
      ofObjects_(library.fragmentPass(kShaders + "borders.frag")),
      ofMovers_(library.compute(kShaders + "mover_borders.comp", {{"MOVERS_ONLY"}})),
      noForms_(gpu::TextureFormat::kR32ui, {1, 1}) {}

void StrokeBorders::draw(const scene::ArFrame& frame, const marks::MotionLayers* movers,
                         const gpu::RenderTarget& target, const marks::SegmentMap* segments,
                         const gpu::Texture* before) {
  const bool hasSegments = segments != nullptr && segments->hasSegments();
  if (!hasSegments) {
    drawSparse(frame, movers, target);
    return;
  }
  begin(all_, frame, movers, segments)
      .texture("before", before != nullptr ? *before : noForms_)
      .set("isHeld", before != nullptr ? 1 : 0)
      .drawFullscreen(target);
}

gpu::Program& StrokeBorders::begin(gpu::Program& program, const scene::ArFrame& frame,
                                   const marks::MotionLayers* movers,
                                   const marks::SegmentMap* segments) const {
  const bool hasDepth = frame.hasObjects && frame.depth != nullptr;
  marks::SegmentMap::bind(program.use(), segments, noForms_);
  bindMovers(program, frame, movers, layerTextures_);
  return program.texture("forms", frame.hasObjects ? *frame.forms : noForms_)
      .texture("depth", hasDepth ? *frame.depth : *frame.colour)
      .set("depthRange", hasDepth ? glm::vec2(frame.nearMetres, frame.farMetres) : glm::vec2(0.0F))
      .set("hasObjects", frame.hasObjects ? 1 : 0)
      .set("objectBounds", frame.objectBoundsOrAll());
}

void StrokeBorders::drawSparse(const scene::ArFrame& frame, const marks::MotionLayers* movers,
                               const gpu::RenderTarget& target) {
  target.beginDiscarding();
  target.clearUnsigned(0, glm::uvec4(kNoBorder));
  if (movers != nullptr) {
    bindMovers(ofMovers_.use(), frame, movers, layerTextures_);
    target.bindAsImages(kFormats);
    movers->busyBlocks().dispatch(ofMovers_,
                                  GL_TEXTURE_FETCH_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT);
  }
  if (!frame.hasObjects) return;
  // A border also reaches the pixels beside an object.
  constexpr int kBeside = 2;
  const hal::FrameSize size = frame.size();
  const auto bounds = glm::ivec4(frame.objectBoundsOrAll());
  const glm::ivec2 low = glm::max(glm::ivec2(bounds) - kBeside, glm::ivec2(0));
  const glm::ivec2 high =
      glm::min(glm::ivec2(bounds.z, bounds.w) + kBeside, glm::ivec2(size.width, size.height));
  if (low.x >= high.x || low.y >= high.y) return;
  begin(ofObjects_, frame, movers, nullptr)
      .texture("before", noForms_)
      .set("isHeld", 0)
      .drawArea(target, low, {high.x - low.x, high.y - low.y});
}

}  // namespace pleinair::styles
