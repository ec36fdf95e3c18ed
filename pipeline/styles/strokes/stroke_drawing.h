#pragma once

#include <optional>
#include <span>

#include "pipeline/gpu/handle.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/marks/strokes/stroke_set.h"
#include "pipeline/styles/debug_views.h"
#include "pipeline/styles/strokes/stroke_strips.h"

namespace pleinair::styles {

/// How a stroke's paint is lit as it is drawn.
struct StrokeLight {
  bool each = false;    ///< each stroke by itself, as the thesis does (§4.4); else not here
  float relief = 0.0F;  ///< how high its brush's marks lie
  float gloss = 0.0F;
};

/// The places where strokes are clipped.
struct StrokeClip {
  /// The borders of what strokes lie on (shaders/borders.glsl), of the target's size; null: none.
  const gpu::Texture* borders = nullptr;
  bool onlyMovers = false;  ///< the borders are those of movers, which there may be or not
  /// The picture, LINEAR: strokes of models and movers fade where its colour is not theirs
  /// (shaders/colour_clip.glsl); null: nowhere.
  const gpu::Texture* picture = nullptr;
  float colour = 1.0F;  ///< by how much, in [0, 1]
  bool byLuma = false;  ///< the strokes' hues are not the picture's
};

/// Draws strips with a style's own program, whose vertices are laid out as for shaders/stroke.vert,
/// over what is in `target`, premultiplied. On the thread of the GL context.
class StripDrawing {
 public:
  StripDrawing();
  /// Draws one part. Precondition: `program` is in use and filled.
  void draw(const gpu::Program& program, const StrokeStrips& strips, StripPart part,
            const gpu::RenderTarget& target) const;

 private:
  gpu::VertexArrayHandle layout_;
};

/// Draws strokes: each a strip of quads along its spline, blended over what is there, colour and
/// height together. All calls on the thread of the GL context it was made in.
class StrokeDrawing {
 public:
  /// `library` has gpu::strokesShaders() and gpu::marksShaders(). `views` are the style's; show()
  /// shows those named layers, skeletons and anchors, without which show() must not be called.
  explicit StrokeDrawing(const gpu::ShaderLibrary& library,
                         std::span<const DebugViewInfo> views = {});

  /// Draws a layer into `target`: colour (sRGB-coded, premultiplied) and height, both RGBA8, over
  /// what is there. `brush` is makeBrush()'s. Precondition: they were laid out with the same
  /// clipping.
  void draw(const StrokeStrips& strips, const gpu::Texture& brush, const StrokeLight& light,
            const StrokeClip& clip, hal::FrameSize full, const gpu::RenderTarget& target);

  /// Uses each program once, so that no frame waits for one; draws nothing. `borders` is any of
  /// StrokeClip's.
  void warmUp(const gpu::Texture& brush, const gpu::Texture& borders,
              const gpu::RenderTarget& target);

  /// Draws a view of a layer's strokes, in its colour, or anchors by their age; `view` is its place
  /// in the style's views. `quads` is the StrokeRule's
  /// that the strokes were laid out by.
  void show(const marks::StrokeSet& strokes, int quads, std::size_t view, const glm::vec3& layer,
            hal::FrameSize full, const gpu::RenderTarget& target);

 private:
  /// The programs of a kind of light.
  struct Paint {
    gpu::Program plain, clipped, carried, carriedClipped;
  };
  static Paint paintOf(const gpu::ShaderLibrary& library, const gpu::ShaderDefines& defines);
  void drawPart(StripPart part, const StrokeStrips& strips, const gpu::Texture& brush,
                const StrokeLight& light, const StrokeClip& clip, hal::FrameSize full,
                const gpu::RenderTarget& target);

  Paint paint_;
  Paint litPaint_;  // each stroke by itself
  std::optional<gpu::Program> view_;
  StripDrawing strips_;
  gpu::VertexArrayHandle instances_;
};

}  // namespace pleinair::styles
