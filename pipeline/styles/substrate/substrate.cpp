#include "pipeline/styles/substrate/substrate.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <glm/common.hpp>

#include "pipeline/gpu/render_target.h"

namespace pleinair::styles {
namespace {

constexpr int kTilePixels = 512;  // shaders/tile.glsl

/// Where a pixel lies on the substrate.
struct Place {
  glm::vec2 linear;  // of the finer octave: complex, substrate px a picture px
  glm::vec2 shift;   // substrate px
  float coarser;     // how much of the coarser octave is seen
};

Place placeOf(const scene::ArFrame& frame) {
  const tracking::PlaneSimilarity& canvasFromPicture = frame.canvasFromPicture;
  // The blend takes the middle of an octave; elsewhere one octave is enough, and half the reads.
  constexpr double kBlendFrom = 0.3;
  constexpr double kBlendTo = 0.7;
  const double octave = std::log2(canvasFromPicture.scale());
  double whole = std::floor(octave + 1e-6);
  const double part = octave - whole;
  double coarser = std::max(0.0, (part - kBlendFrom) / (kBlendTo - kBlendFrom));
  if (coarser >= 1.0) {
    whole += 1.0;
    coarser = 0.0;
  }
  const double finer = std::exp2(-whole);
  // The lowest frequency that is read is an eighth's (pigment.frag, and its coarser octave).
  const double period = 8.0 * kTilePixels;
  const glm::dvec2 shift = canvasFromPicture.shift * finer;
  return {.linear = canvasFromPicture.linear * finer / frame.pixelsOfFull().x,
          .shift = shift - period * glm::floor(shift / period),
          .coarser = static_cast<float>(coarser)};
}

}  // namespace

Substrate::Substrate(const gpu::ShaderLibrary& library, Kind kind)
    : tile_(gpu::TextureFormat::kRgba8, {kTilePixels, kTilePixels}, gpu::TextureFilter::kLinear,
            gpu::TextureWrap::kRepeat) {
  const char* shader = kind == Kind::kPaper ? "paper.frag" : "linen.frag";
  library.fragmentPass(std::string("pipeline/styles/substrate/shaders/") + shader)
      .use()
      .set("one", 1)
      .drawFullscreen(gpu::RenderTarget({&tile_}));
}

void Substrate::bind(gpu::Program& program, const scene::ArFrame& frame) const {
  const Place place = placeOf(frame);
  program.texture("paper", tile_)
      .set("paperLinear", place.linear)
      .set("paperShift", place.shift)
      .set("coarser", place.coarser);
}

}  // namespace pleinair::styles
