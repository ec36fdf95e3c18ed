#include "pipeline/styles/painterly/stroke_drawing.h"

namespace pleinair::styles {
namespace {

constexpr GLuint kAttributes = 6;  // of stroke.vert, four floats each

}  // namespace

StrokeDrawing::StrokeDrawing(const gpu::ShaderLibrary& library)
    : program_(library.draw("pipeline/styles/painterly/shaders/stroke.vert",
                            "pipeline/styles/painterly/shaders/stroke.frag")),
      view_(library.draw("pipeline/styles/painterly/shaders/stroke_view.vert",
                         "pipeline/styles/painterly/shaders/stroke_view.frag")),
      vertexArray_(gpu::VertexArrayHandle::make()) {
  static_assert(kAttributes * 16 == marks::StrokeSet::kInstanceBytes);
  glBindVertexArray(vertexArray_.get());
  for (GLuint i = 0; i < kAttributes; ++i) {
    glVertexAttribFormat(i, 4, GL_FLOAT, GL_FALSE, 16 * i);
    glVertexAttribBinding(i, 0);
    glEnableVertexAttribArray(i);
  }
  glVertexBindingDivisor(0, 1);
  glBindVertexArray(0);
}

void StrokeDrawing::draw(const marks::StrokeSet& strokes, int quads, const gpu::Texture& brush,
                         hal::FrameSize full, const gpu::RenderTarget& target) {
  program_.use()
      .texture("brushes", brush)
      .set("quads", static_cast<float>(quads))
      .set("fullSize", glm::vec2(full.width, full.height));
  drawInstances(strokes, target);
}

void StrokeDrawing::show(const marks::StrokeSet& strokes, int quads, Shown shown,
                         const glm::vec3& layer, hal::FrameSize full,
                         const gpu::RenderTarget& target) {
  view_.use()
      .set("quads", static_cast<float>(quads))
      .set("shown", static_cast<int>(shown))
      .set("layer", layer)
      .set("fullSize", glm::vec2(full.width, full.height));
  drawInstances(strokes, target);
}

void StrokeDrawing::drawInstances(const marks::StrokeSet& strokes,
                                  const gpu::RenderTarget& target) {
  target.beginKeeping();
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glBindVertexArray(vertexArray_.get());
  glBindVertexBuffer(0, strokes.instances().name(), 0, marks::StrokeSet::kInstanceBytes);
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, strokes.command().name());
  glDrawArraysIndirect(GL_TRIANGLE_STRIP, nullptr);
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, 0);
  glBindVertexBuffer(0, 0, 0, marks::StrokeSet::kInstanceBytes);
  glBindVertexArray(0);
  glDisable(GL_BLEND);
}

}  // namespace pleinair::styles
