#include "pipeline/styles/strokes/stroke_drawing.h"

#include <cassert>
#include <cstddef>
#include <initializer_list>
#include <string>

namespace pleinair::styles {
namespace {

const std::string kShaders = "pipeline/styles/strokes/shaders/";
constexpr GLuint kInstanceAttributes = 6;  // of stroke_spline.glsl, four floats each

gpu::Program paintProgram(const gpu::ShaderLibrary& library, const gpu::ShaderDefines& defines) {
  return library.draw(kShaders + "stroke.vert", kShaders + "stroke.frag", defines);
}

gpu::VertexArrayHandle instanceLayout() {
  static_assert(std::size_t{kInstanceAttributes} * 16 == marks::StrokeSet::kInstanceBytes);
  gpu::VertexArrayHandle array = gpu::VertexArrayHandle::make();
  glBindVertexArray(array.get());
  for (GLuint i = 0; i < kInstanceAttributes; ++i) {
    glVertexAttribFormat(i, 4, GL_FLOAT, GL_FALSE, 16 * i);
    glVertexAttribBinding(i, 0);
    glEnableVertexAttribArray(i);
  }
  glVertexBindingDivisor(0, 1);
  glBindVertexArray(0);
  return array;
}

/// The vertex layout that shaders/stroke_strips.comp packs for stroke.vert.
gpu::VertexArrayHandle stripLayout() {
  gpu::VertexArrayHandle array = gpu::VertexArrayHandle::make();
  glBindVertexArray(array.get());
  glVertexAttribFormat(0, 2, GL_FLOAT, GL_FALSE, 0);
  glVertexAttribFormat(1, 2, GL_UNSIGNED_SHORT, GL_TRUE, 8);
  glVertexAttribFormat(2, 2, GL_SHORT, GL_TRUE, 12);
  glVertexAttribFormat(3, 4, GL_HALF_FLOAT, GL_FALSE, 16);
  glVertexAttribFormat(4, 2, GL_HALF_FLOAT, GL_FALSE, 24);
  glVertexAttribIFormat(5, 1, GL_UNSIGNED_INT, 28);
  for (GLuint i = 0; i < 6; ++i) {
    glVertexAttribBinding(i, 0);
    glEnableVertexAttribArray(i);
  }
  glBindVertexArray(0);
  return array;
}

/// Blends what the command draws of the vertices over what is there.
void drawOver(const gpu::Program& program, const gpu::RenderTarget& target,
              const gpu::VertexArrayHandle& layout, const gpu::Buffer& vertices,
              std::size_t strideBytes, const gpu::Buffer& commands, std::size_t command) {
  const auto stride = static_cast<GLsizei>(strideBytes);
  target.beginKeeping();
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glBindVertexArray(layout.get());
  glBindVertexBuffer(0, vertices.name(), 0, stride);
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands.name());
  const gpu::PassTimer::Scope scope = program.measure();
  glDrawArraysIndirect(GL_TRIANGLE_STRIP,
                       reinterpret_cast<const void*>(command * gpu::kDrawCommandBytes));
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, 0);
  glBindVertexBuffer(0, 0, 0, stride);
  glBindVertexArray(0);
  glDisable(GL_BLEND);
}

}  // namespace

StripDrawing::StripDrawing() : layout_(stripLayout()) {}

void StripDrawing::draw(const gpu::Program& program, const StrokeStrips& strips, StripPart part,
                        const gpu::RenderTarget& target) const {
  drawOver(program, target, layout_, strips.vertices, StrokeStrips::kVertexBytes, strips.commands,
           static_cast<std::size_t>(part));
}

StrokeDrawing::Paint StrokeDrawing::paintOf(const gpu::ShaderLibrary& library,
                                            const gpu::ShaderDefines& defines) {
  const auto with = [&](std::initializer_list<const char*> more) {
    gpu::ShaderDefines all = defines;
    for (const char* each : more) all.push_back({each});
    return paintProgram(library, all);
  };
  return {.plain = with({}),
          .clipped = with({"CLIPPED"}),
          .carried = with({"CARRIED"}),
          .carriedClipped = with({"CLIPPED", "CARRIED"})};
}

StrokeDrawing::StrokeDrawing(const gpu::ShaderLibrary& library,
                             std::span<const DebugViewInfo> views)
    : paint_(paintOf(library, {})),
      litPaint_(paintOf(library, {{"BUMPED"}})),
      instances_(instanceLayout()) {
  if (views.empty()) return;
  view_ = library.draw(kShaders + "stroke_view.vert", kShaders + "stroke_view.frag",
                       viewDefines(views));
}

void StrokeDrawing::draw(const StrokeStrips& strips, const gpu::Texture& brush,
                         const StrokeLight& light, const StrokeClip& clip, hal::FrameSize full,
                         const gpu::RenderTarget& target) {
  // One of these two draws nothing.
  if (clip.borders == nullptr || clip.onlyMovers) {
    drawPart(StripPart::kPlain, strips, brush, light, clip, full, target);
  }
  if (clip.borders != nullptr) {
    drawPart(StripPart::kClipped, strips, brush, light, clip, full, target);
  }
  drawPart(StripPart::kCarried, strips, brush, light, clip, full, target);
}

void StrokeDrawing::drawPart(StripPart part, const StrokeStrips& strips, const gpu::Texture& brush,
                             const StrokeLight& light, const StrokeClip& clip, hal::FrameSize full,
                             const gpu::RenderTarget& target) {
  Paint& paint = light.each ? litPaint_ : paint_;
  const bool isCarried = part == StripPart::kCarried;
  const bool isClipped = part == StripPart::kClipped || (isCarried && clip.borders != nullptr);
  gpu::Program& program = isCarried   ? (isClipped ? paint.carriedClipped : paint.carried)
                          : isClipped ? paint.clipped
                                      : paint.plain;
  const hal::FrameSize size = target.size();
  program.use().texture("brushes", brush).set("fullSize", glm::vec2(full.width, full.height));
  if (light.each) program.set("relief", light.relief).set("gloss", light.gloss);
  if (isClipped) program.texture("borders", *clip.borders);
  if (isClipped && isCarried) {
    program.texture("picture", clip.picture != nullptr ? *clip.picture : brush)
        .set("colourClip", clip.picture != nullptr ? clip.colour : 0.0F)
        .set("byLuma", clip.byLuma ? 1 : 0)
        .set("targetSize", glm::vec2(size.width, size.height));
  }
  strips_.draw(program, strips, part, target);
}

void StrokeDrawing::warmUp(const gpu::Texture& brush, const gpu::Texture& borders,
                           const gpu::RenderTarget& target) {
  const StrokeStrips blank = StrokeStrips::blank();
  for (const bool each : {true, false}) {
    draw(blank, brush, {.each = each}, {}, target.size(), target);
    draw(blank, brush, {.each = each}, {.borders = &borders, .picture = &brush}, target.size(),
         target);
  }
}

void StrokeDrawing::show(const marks::StrokeSet& strokes, int quads, std::size_t view,
                         const glm::vec3& layer, hal::FrameSize full,
                         const gpu::RenderTarget& target) {
  assert(view_);
  view_->use()
      .set("quads", static_cast<float>(quads))
      .set("view", static_cast<int>(view))
      .set("layer", layer)
      .set("fullSize", glm::vec2(full.width, full.height));
  drawOver(*view_, target, instances_, strokes.instances(), marks::StrokeSet::kInstanceBytes,
           strokes.command(), 0);
}

}  // namespace pleinair::styles
