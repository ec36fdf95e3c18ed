#pragma once

#include <cstddef>
#include <optional>

#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/marks/movers/busy_blocks.h"
#include "pipeline/marks/strokes/stroke_set.h"

namespace pleinair::styles {

/// Into how many quads a stroke is broken.
enum class StrokeQuads {
  kCurvature,  ///< as few as its curvature needs, or two where storage is short of that; long
               ///< strokes have nine at least
  kThesis,     ///< 4 (n + 2) for n + 1 control points (§4.4): 36, evenly; fewer where storage is
               ///< short of them
};

/// Which strokes a StrokeStripMaker lays out.
enum class StrokeForm {
  kShort,  ///< marks::StrokeSet's, of 8 points and one width
  kLong,   ///< of 16 points, with a width at each (shaders/long_instance.glsl)
};
/// Bytes of a stroke's instance.
constexpr std::size_t instanceBytesOf(StrokeForm form) {
  return form == StrokeForm::kLong ? 224 : marks::StrokeSet::kInstanceBytes;
}

/// The strokes that one program draws. Strokes that lie on neither models nor movers are all in
/// kPlain or all in kClipped; the others are in kCarried.
enum class StripPart { kPlain, kClipped, kCarried };
inline constexpr std::size_t kStripParts = 3;

/// The vertices of a layer's strokes, all one strip, in the order of painting, carried strokes
/// last.
struct StrokeStrips {
  StrokeQuads quads = StrokeQuads::kCurvature;  ///< that there is room for
  gpu::Buffer plans;
  gpu::Buffer vertices;
  gpu::Buffer commands;  ///< glDrawArraysIndirect's, one for each StripPart

  static constexpr std::size_t kVertexBytes = 32;  ///< shaders/stroke_strips.comp

  /// A strip of no area in each part. Drivers make a program ready when it first draws, and draw
  /// nothing for an empty part.
  static StrokeStrips blank();
};

/// By what strokes are clipped.
struct StripClipping {
  bool clips = false;
  /// If there is nothing but movers to clip them by: where these are. While there are none, strokes
  /// are not clipped, which is faster.
  std::optional<marks::BusyBlocks> onlyMovers = std::nullopt;
};

/// Lays strokes out as strips of quads along their splines. All calls on the thread of the GL
/// context it was made in.
class StrokeStripMaker {
 public:
  /// `library` has gpu::strokesShaders() and gpu::marksShaders().
  explicit StrokeStripMaker(const gpu::ShaderLibrary& library,
                            StrokeForm form = StrokeForm::kShort);

  /// Fills `strips` with strokes of the constructor's form, such as marks::StrokeSet's instances()
  /// and command(). They are allocated at the first call, for as many strokes as `instances` has
  /// room for, and where `quads` is other than before: hal::Failure where the GPU has no memory
  /// for it. Precondition: `instances` is of the same size as at the first call.
  void lay(const gpu::Buffer& instances, const gpu::Buffer& drawn, StrokeQuads quads,
           StrokeStrips& strips, const StripClipping& clipping = {});

 private:
  StrokeForm form_;
  gpu::Program bend_;
  gpu::Program offsets_;
  gpu::Program lay_;
};

}  // namespace pleinair::styles
