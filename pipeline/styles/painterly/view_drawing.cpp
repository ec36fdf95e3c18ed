#include "pipeline/styles/painterly/view_drawing.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec4.hpp>

#include "pipeline/styles/painterly/painterly_views.h"

namespace pleinair::styles {
namespace {

using gpu::Texture;

const std::string kViewShaders = "pipeline/styles/painterly/shaders/";

glm::vec2 sizeOf(const scene::ArFrame& frame) {
  return {frame.size().width, frame.size().height};
}

}  // namespace

ViewDrawing::ViewDrawing(const gpu::ShaderLibrary& library)
    : field_(library.fragmentPass(kViewShaders + "field_view.frag", viewDefines(painterlyViews()))),
      movers_(
          library.fragmentPass(kViewShaders + "mover_view.frag", viewDefines(painterlyViews()))),
      segments_(library.fragmentPass(kViewShaders + "segment_view.frag")),
      features_(library.fragmentPass(kViewShaders + "feature_view.frag")),
      height_(library.fragmentPass(kViewShaders + "height_view.frag")),
      noBorders_(gpu::TextureFormat::kR32ui, {1, 1}),
      featurePlaces_(gpu::TextureFormat::kRgba32f,
                     {static_cast<int>(tracking::kMaxMovedFeatures), 1}) {}

void ViewDrawing::showField(const scene::ArFrame& frame, const marks::TensorField& field,
                            const marks::FocusField& focus, glm::vec2 bands, std::size_t view,
                            const gpu::RenderTarget& target) {
  const auto level = [&](std::size_t i) -> const Texture& {
    return field.resolved(std::min(i, field.levelCount() - 1));
  };
  field_.use()
      .texture("picture", *frame.colour)
      .texture("field0", level(0))
      .texture("field1", level(1))
      .texture("field2", level(2))
      .texture("field3", level(3))
      .set("size", sizeOf(frame))
      .set("view", static_cast<int>(view))
      .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()))
      .set("bands", bands);
  focus.bind(field_);
  field_.drawFullscreen(target);
}

void ViewDrawing::showMovers(const scene::ArFrame& frame, const marks::MotionLayers* movers,
                             std::size_t view, const gpu::RenderTarget& target) {
  movers_.use()
      .texture("picture", *frame.colour)
      .texture("movers", layerTextures_.labelsOf(movers))
      .texture("moverShares", layerTextures_.sharesOf(movers))
      .texture("background", layerTextures_.backgroundOf(movers))
      .set("size", sizeOf(frame))
      .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()))
      .set("view", static_cast<int>(view))
      .drawFullscreen(target);
}

void ViewDrawing::showSegments(const scene::ArFrame& frame, const Texture* borders,
                               const gpu::RenderTarget& target) {
  segments_.use()
      .texture("picture", *frame.colour)
      .texture("borders", borders != nullptr ? *borders : noBorders_)
      .set("hasBorders", borders != nullptr ? 1 : 0)
      .set("size", sizeOf(frame))
      .drawFullscreen(target);
}

void ViewDrawing::showFeatures(const scene::ArFrame& frame, const gpu::RenderTarget& target) {
  std::vector<glm::vec4> places(tracking::kMaxMovedFeatures);
  std::size_t count = 0;
  if (frame.measuredMotion) {
    const scene::MeasuredMotion& measured = *frame.measuredMotion;
    const auto inFull = [&](glm::vec2 px) {
      return glm::vec2((glm::dvec2(px) - measured.frameOrigin) / measured.frameScale);
    };
    for (const tracking::FeatureMotion& each : measured.motion->features) {
      places[count++] = glm::vec4(inFull(each.previous), inFull(each.current));
    }
  }
  const std::size_t bytes = places.size() * sizeof(glm::vec4);
  featurePlaces_.upload({reinterpret_cast<const std::uint8_t*>(places.data()), bytes}, bytes);
  features_.use()
      .texture("picture", *frame.colour)
      .texture("features", featurePlaces_)
      .set("count", static_cast<int>(count))
      .set("size", sizeOf(frame))
      .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()))
      .drawFullscreen(target);
}

void ViewDrawing::showHeight(const Texture& heights, const gpu::RenderTarget& target) {
  height_.use().texture("heights", heights).drawFullscreen(target);
}

}  // namespace pleinair::styles
