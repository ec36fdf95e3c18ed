#pragma once

#include "pipeline/gpu/handle.h"
#include "pipeline/gpu/program.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/shader_library.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/marks/stroke_set.h"
#include "pipeline/styles/painterly/stroke_strips.h"

namespace pleinair::styles {

/// Draws strokes: each a strip of quads along its spline, blended over what is there, colour and
/// height together. All calls on the thread of the GL context it was made in.
class StrokeDrawing {
 public:
  /// `library` has gpu::painterlyShaders() and gpu::marksShaders().
  explicit StrokeDrawing(const gpu::ShaderLibrary& library);

  /// Draws a layer into `target`: colour (sRGB-coded, premultiplied) and height, both RGBA8, over
  /// what is there. `brush` is makeBrush()'s.
  void draw(const StrokeStrips& strips, const gpu::Texture& brush, hal::FrameSize full,
            const gpu::RenderTarget& target);

  /// What can be shown of strokes instead of their paint.
  enum class Shown { kWhole, kSkeletons, kAnchors };
  /// Draws that of a layer, in its colour, or anchors by their age. `quads` is the StrokeRule's
  /// that the strokes were laid out by.
  void show(const marks::StrokeSet& strokes, int quads, Shown shown, const glm::vec3& layer,
            hal::FrameSize full, const gpu::RenderTarget& target);

 private:
  gpu::Program program_;
  gpu::Program view_;
  gpu::VertexArrayHandle strips_;
  gpu::VertexArrayHandle instances_;
};

}  // namespace pleinair::styles
