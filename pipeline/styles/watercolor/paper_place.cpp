#include "pipeline/styles/watercolor/paper_place.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

namespace pleinair::styles {

PaperPlace paperPlace(const scene::ArFrame& frame) {
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
  const double period = 8.0 * kPaperPixels;
  const glm::dvec2 shift = canvasFromPicture.shift * finer;
  return {.linear = canvasFromPicture.linear * finer / frame.pixelsOfFull().x,
          .shift = shift - period * glm::floor(shift / period),
          .coarser = static_cast<float>(coarser)};
}

}  // namespace pleinair::styles
