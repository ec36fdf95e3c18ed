#include "pipeline/styles/hatching/drawing_plan.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include <glm/trigonometric.hpp>

namespace pleinair::styles {
namespace {

/// Lengths are given for pictures of so many px (640x480).
constexpr double kReferencePixels = 307200.0;
/// In smaller images, lines would be thinner than a pixel.
constexpr double kMinScale = 0.6;
constexpr std::size_t kFieldLevel = 1;

/// Where each set draws, in the tones that are not left bare: the more sets, the earlier the first
/// has drawn all its lines.
constexpr std::array<std::array<glm::vec2, kMaxHatchSets>, kMaxHatchSets> kBands{{
    {{{0.0F, 1.0F}, {0.0F, 1.0F}, {0.0F, 1.0F}}},
    {{{0.0F, 0.75F}, {0.4F, 1.0F}, {0.0F, 1.0F}}},
    {{{0.0F, 0.65F}, {0.35F, 0.85F}, {0.6F, 1.0F}}},
}};

/// The tensor (shaders/field.glsl) of lines at a slope on the paper, which has turned with the
/// image.
glm::vec2 slopeOf(const HatchingParameters& p, const scene::ArFrame& frame) {
  const double line = -glm::radians(p.slopeDegrees) - frame.canvasFromPicture.angleRad();
  return {-std::cos(2.0 * line), -std::sin(2.0 * line)};
}

}  // namespace

double hatchScale(hal::FrameSize full) {
  return std::max(kMinScale, std::sqrt(static_cast<double>(full.pixels()) / kReferencePixels));
}

DrawingPlan drawingPlanOf(const HatchingParameters& p, hal::FrameSize full) {
  const double scale = hatchScale(full);
  return {static_cast<std::size_t>(p.directions),
          {.spacingPx = p.spacing * scale,
           .lengthPx = p.length * scale,
           .coverage = p.coverage,
           .seed = static_cast<unsigned>(p.seed)}};
}

glm::vec3 inkColourOf(const HatchingParameters& p) {
  return {p.inkRed, p.inkGreen, p.inkBlue};
}

marks::FidelityField fidelityOf(const HatchingParameters& p, const scene::ArFrame& frame) {
  return marks::fidelityOfFaces(frame, p.faces, p.spacing * hatchScale(frame.full()));
}

HatchRule hatchRuleOf(const HatchingParameters& p, const scene::ArFrame& frame, std::size_t set) {
  const auto scale = static_cast<float>(hatchScale(frame.full()));
  const auto bare = static_cast<float>(p.paperTone);
  HatchRule rule;
  rule.band = bare + (1.0F - bare) * kBands.at(static_cast<std::size_t>(p.directions) - 1).at(set);
  rule.swell = static_cast<float>(p.swell);
  rule.widthPx = static_cast<float>(p.width) * scale;
  rule.isInverted = p.inverted;
  rule.darkness = static_cast<float>(p.darkness);
  rule.gamma = static_cast<float>(p.gamma);
  rule.lead = static_cast<float>(p.lead);
  rule.slope = slopeOf(p, frame);
  const std::array<double, kMaxHatchSets> turns{0.0, p.crossDegrees, -p.crossDegrees};
  rule.turnRad = glm::radians(static_cast<float>(turns.at(set)));
  rule.wanderRad = static_cast<float>(p.wander);
  rule.cutOffRad = glm::radians(static_cast<float>(p.cutOffDegrees));
  rule.taper = static_cast<float>(p.taper);
  rule.evenness = static_cast<float>(p.evenness);
  rule.fieldLevel = kFieldLevel;
  rule.shapeMemory =
      std::chrono::duration_cast<hal::Duration>(std::chrono::duration<double>(p.shapeTimeSeconds));
  rule.fade =
      std::chrono::duration_cast<hal::Duration>(std::chrono::duration<double>(p.fadeTimeSeconds));
  rule.paint = glm::vec4(inkColourOf(p), static_cast<float>(p.opacity));
  rule.colour = static_cast<float>(p.colour);
  rule.fidelity = fidelityOf(p, frame);
  return rule;
}

}  // namespace pleinair::styles
