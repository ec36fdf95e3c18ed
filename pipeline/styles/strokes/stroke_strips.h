#pragma once

#include <cstddef>

#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/program.h"
#include "pipeline/gpu/shader_library.h"
#include "pipeline/marks/stroke_set.h"

namespace pleinair::styles {

/// Into how many quads a stroke is broken.
enum class StrokeQuads {
  kCurvature,  ///< as few as its curvature needs
  kThesis,     ///< 4 (n + 2) for n + 1 control points (§4.4): 36, evenly; fewer where storage is
               ///< short of them
};

/// The vertices of a layer's strokes, all one strip, in the order of painting.
struct StrokeStrips {
  StrokeQuads quads = StrokeQuads::kCurvature;  ///< that there is room for
  gpu::Buffer plans;
  gpu::Buffer vertices;
  gpu::Buffer command;  ///< glDrawArraysIndirect's

  static constexpr std::size_t kVertexBytes = 32;  ///< shaders/stroke_strips.comp
};

/// Lays strokes out as strips of quads along their splines. All calls on the thread of the GL
/// context it was made in.
class StrokeStripMaker {
 public:
  /// `library` has gpu::strokesShaders() and gpu::marksShaders().
  explicit StrokeStripMaker(const gpu::ShaderLibrary& library);

  /// Fills `strips` with what marks::StrokeSet laid out: its instances() and command(). They are
  /// allocated at the first call and where `quads` is other than before: hal::Failure where
  /// the GPU has no memory for it.
  void lay(const gpu::Buffer& instances, const gpu::Buffer& drawn, StrokeQuads quads,
           StrokeStrips& strips);

 private:
  gpu::Program bend_;
  gpu::Program offsets_;
  gpu::Program lay_;
};

}  // namespace pleinair::styles
