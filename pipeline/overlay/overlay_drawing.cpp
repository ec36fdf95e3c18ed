#include "pipeline/overlay/overlay_drawing.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>

#include <glm/common.hpp>

namespace pleinair::overlay {
namespace {

constexpr std::size_t kCornersOfBox = 6;
constexpr float kCasing = 1.6F;

void beginBlending() {
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
}

void endBlending() {
  glBindVertexArray(0);
  glDisable(GL_BLEND);
}

glm::vec2 sizeOf(const gpu::RenderTarget& target) {
  return {target.size().width, target.size().height};
}

}  // namespace

Sprite::Sprite(const hal::Image& image) {
  if (image.size().width == 0 || image.size().height == 0) return;
  assert(image.format().pixelFormat == hal::PixelFormat::kRgba8);
  texture_ = gpu::Texture(gpu::TextureFormat::kRgba8, image.size());
  const hal::ImageView view = image.view();
  texture_.upload(view.planes[0].bytes, view.planes[0].strideBytes);
}

OverlayDrawing::OverlayDrawing(const gpu::ShaderLibrary& library)
    : line_(
          library.draw("pipeline/overlay/shaders/line.vert", "pipeline/overlay/shaders/line.frag")),
      sprite_(library.draw("pipeline/overlay/shaders/sprite.vert",
                           "pipeline/overlay/shaders/sprite.frag")),
      lineVertices_(LineShapes::kMost * kCornersOfBox * sizeof(LineVertex),
                    gpu::BufferUsage::kDynamic),
      lineArray_(gpu::VertexArrayHandle::make()),
      emptyArray_(gpu::VertexArrayHandle::make()) {
  gathered_.reserve(LineShapes::kMost * kCornersOfBox);
  glBindVertexArray(lineArray_.get());
  glVertexAttribFormat(0, 2, GL_FLOAT, GL_FALSE, offsetof(LineVertex, corner));
  glVertexAttribFormat(1, 4, GL_FLOAT, GL_FALSE, offsetof(LineVertex, firstPoints));
  glVertexAttribFormat(2, 4, GL_FLOAT, GL_FALSE, offsetof(LineVertex, lastPoint));
  for (const GLuint i : {0U, 1U, 2U}) {
    glVertexAttribBinding(i, 0);
    glEnableVertexAttribArray(i);
  }
  glBindVertexArray(0);
}

void OverlayDrawing::drawLines(const gpu::RenderTarget& target, std::span<const LineShape> shapes,
                               float pxScale, float opacity) {
  if (shapes.empty() || opacity <= 0.0F) return;
  const float casing = kCasing * pxScale;
  gathered_.clear();
  for (const LineShape& each : shapes) {
    const float margin = each.halfWidthPx + casing + 1.0F;
    glm::vec2 low = glm::min(each.a, each.b);
    glm::vec2 high = glm::max(each.a, each.b);
    if (each.isTriangle) {
      low = glm::min(low, each.c);
      high = glm::max(high, each.c);
    }
    low -= margin;
    high += margin;
    const std::array<glm::vec2, kCornersOfBox> corners{
        {low, {high.x, low.y}, high, low, high, {low.x, high.y}}};
    for (const glm::vec2& corner : corners) {
      gathered_.push_back({.corner = corner,
                           .firstPoints = {each.a, each.b},
                           .lastPoint = {each.c, each.halfWidthPx, each.isTriangle ? 1.0F : 0.0F}});
    }
  }
  lineVertices_.write(std::as_bytes(std::span(gathered_)));
  target.beginKeeping();
  line_.use().set("outputSize", sizeOf(target)).set("casingPx", casing).set("opacity", opacity);
  beginBlending();
  glBindVertexArray(lineArray_.get());
  glBindVertexBuffer(0, lineVertices_.name(), 0, sizeof(LineVertex));
  const gpu::PassTimer::Scope scope = line_.measure();
  for (const int isCasing : {1, 0}) {  // so that lines of one arrow have no casing between them
    line_.set("isCasing", isCasing);
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(gathered_.size()));
  }
  endBlending();
}

void OverlayDrawing::drawSprite(const gpu::RenderTarget& target, const Sprite& sprite,
                                glm::ivec2 topLeft, float opacity) {
  if (sprite) drawTexture(target, sprite.texture(), topLeft, sprite.size(), opacity);
}

void OverlayDrawing::drawTexture(const gpu::RenderTarget& target, const gpu::Texture& picture,
                                 glm::ivec2 topLeft, hal::FrameSize size, float opacity) {
  if (opacity <= 0.0F) return;
  target.beginKeeping();
  sprite_.use()
      .set("origin", glm::vec2(topLeft))
      .set("size", glm::vec2(size.width, size.height))
      .set("outputSize", sizeOf(target))
      .set("opacity", opacity)
      .texture("picture", picture);
  beginBlending();
  glBindVertexArray(emptyArray_.get());
  const gpu::PassTimer::Scope scope = sprite_.measure();
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  endBlending();
}

}  // namespace pleinair::overlay
