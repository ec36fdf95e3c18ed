#include "pipeline/scene/render/buffer_views.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace pleinair::scene {
namespace {

/// shaders/buffer_view.frag numbers them in this order.
constexpr std::array<BufferView, 11> kViews{
    {{"depth", "how near models are: white is nearest", {}},
     {"objects", "a colour for each model; black is the camera's picture", {}},
     {"parts", "a colour for each part of each model", {.surfaces = true}},
     {"triangles", "a colour for each triangle", {}},
     {"barycentrics",
      "where on its triangle each pixel is: red, green, blue at its corners",
      {.surfaces = true}},
     {"normals", "where surfaces face: x, y, z of the camera's frame as red, green, blue", {}},
     {"focus", "white: kept crisp; black: painted like the rest", {}},
     {"motion",
      "where each pixel of a model has come to since the frame before: hue the direction (red: to "
      "the right), full colour 16 px; grey: it stands still; black: the camera's picture",
      {.surfaces = true}},
     {"motion_error",
      "how well the view motion is known: white: exactly, yellow: to 0.25 px, red: to 1 px; black: "
      "not at all, or the camera's picture",
      {.surfaces = true}},
     {"patches",
      "a colour for each smooth patch of a model, at whose borders strokes end",
      {.surfaces = true}},
     {"form",
      "the direction in which surfaces bend least: its hue (red: level, blue-green: upright); "
      "grey: "
      "none",
      {.surfaces = true}}}};

gpu::Texture blank(gpu::TextureFormat format) {
  gpu::Texture texture(format, {1, 1});
  const gpu::RenderTarget target({&texture});
  target.beginDiscarding();
  if (format == gpu::TextureFormat::kR32ui) {
    target.clearUnsigned(0, glm::uvec4(0U));
  } else {
    target.clearColour(0, glm::vec4(0.0F));
  }
  return texture;
}

}  // namespace

std::span<const BufferView> bufferViews() {
  return kViews;
}

const BufferView* findBufferView(std::string_view name) {
  const auto* const found = std::ranges::find(kViews, name, &BufferView::name);
  return found == kViews.end() ? nullptr : found;
}

BufferViewer::BufferViewer(const gpu::ShaderLibrary& library)
    : program_(library.fragmentPass("pipeline/scene/render/shaders/buffer_view.frag")),
      noIds_(blank(gpu::TextureFormat::kR32ui)),
      noMotion_(blank(gpu::TextureFormat::kRgba8)) {}

BufferViewer::Canvas::Canvas(hal::FrameSize size)
    : picture(gpu::TextureFormat::kRgba8, size, gpu::TextureFilter::kLinear), target({&picture}) {}

const gpu::Texture& BufferViewer::show(const BufferView& view, const ArFrame& frame) {
  const Canvas& canvas = canvases_.of(frame.size(), frame.size());
  const auto orNothing = [&](const gpu::Texture* texture) -> const gpu::Texture& {
    return texture != nullptr ? *texture : noIds_;
  };
  program_.use()
      .set("view", static_cast<int>(&view - kViews.data()))
      .set("depthRange", glm::vec2(frame.nearMetres, frame.farMetres))
      .texture("ids", *frame.ids)
      .texture("depth", *frame.depth)
      .texture("normalFocus", *frame.normalFocus)
      .texture("parts", orNothing(frame.parts))
      .texture("forms", orNothing(frame.forms))
      .texture("barycentrics", orNothing(frame.barycentrics))
      .texture("motion", frame.motion ? *frame.motion->texture : noMotion_)
      .drawFullscreen(canvas.target);
  return canvas.picture;
}

}  // namespace pleinair::scene
