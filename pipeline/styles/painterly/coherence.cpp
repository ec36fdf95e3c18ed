#include "pipeline/styles/painterly/coherence.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

namespace pleinair::styles {
namespace {

/// The `memory` at which other time constants have their own values: the thesis's weight of 0.95 on
/// the past, at 30 frames a second (thesis §5.4).
constexpr double kMemorySeconds = 0.65;
constexpr double kAppearingSeconds = 0.3;
constexpr double kForever = 1e6;
/// Limits the memory of the field and the anchors, so that new strokes follow the present image.
constexpr double kMaxHold = 4.0;
/// The differences of colour from which a stroke stands on other content (StrokeRule::otherColour):
/// those of an image without noise, and the standard deviations of the noise that are added.
constexpr glm::vec2 kOtherColour{0.09F, 0.18F};
constexpr glm::vec2 kOtherColourNoises{2.5F, 5.0F};
constexpr float kFlatHold = 100.0F;
constexpr float kAnyColour = 1e6F;  // a second

hal::Duration scaled(hal::Duration time, double hold) {
  return std::chrono::duration_cast<hal::Duration>(std::chrono::duration<double>(time) * hold);
}
hal::Duration secondsOf(double seconds) {
  return std::chrono::duration_cast<hal::Duration>(std::chrono::duration<double>(seconds));
}

/// `memory`, as a factor of what it is by default.
double memoryOf(const PainterlyParameters& p) {
  return p.memorySeconds / kMemorySeconds;
}

}  // namespace

double holdOf(const PainterlyParameters& p) {
  if (p.coherence >= 1.0) return kForever;
  return std::min(kForever, std::tan(p.coherence * 0.5 * std::numbers::pi));
}

marks::MotionFieldOptions motionOf(const PainterlyParameters& p) {
  return {.follows = p.warp};
}

marks::TensorFieldOptions fieldOf(const PainterlyParameters& p) {
  marks::TensorFieldOptions options;
  const double hold = p.history ? std::min(holdOf(p) * memoryOf(p), kMaxHold) : 0.0;
  options.memory = scaled(options.memory, hold);
  if (!p.hysteresis || p.coherence <= 0.0) options.slack = 0.0;
  return options;
}

marks::AnchorHold anchorHoldOf(const PainterlyParameters& p) {
  marks::AnchorHold anchors;
  const double hold = p.fades ? std::min(holdOf(p), kMaxHold) : 0.0;
  anchors.fadeIn = scaled(anchors.fadeIn, hold);
  anchors.fadeOut = scaled(anchors.fadeOut, hold);
  anchors.hasSlack = p.hysteresis;
  anchors.underModels = p.clip;
  return anchors;
}

bool tellsMovers(const PainterlyParameters& p) {
  return p.warp && p.movers && p.coherence > 0.0 && p.coherence < 1.0;
}

void holdOn(marks::StrokeRule& rule, const PainterlyParameters& p, double noiseLevels) {
  const double history = p.history ? holdOf(p) * memoryOf(p) : 0.0;
  rule.shapeMemory = rule.colourMemory = secondsOf(history * kMemorySeconds);
  const double quickest = rule.maxColourPerSecond / std::max(history, 1e-6);
  rule.maxColourPerSecond = std::min(kAnyColour, static_cast<float>(quickest));
  if (p.history && p.coherence < 1.0) {
    const auto noise = static_cast<float>(noiseLevels / 255.0);
    rule.otherColour = kOtherColour + kOtherColourNoises * noise;
    // What is plain is held longer only by strokes that are held at all.
    rule.flatHold = 1.0F + (kFlatHold - 1.0F) * static_cast<float>(std::min(1.0, memoryOf(p)));
  }
  const double fades = p.fades ? holdOf(p) : 0.0;
  rule.appearing = rule.vanishing = secondsOf(fades * kAppearingSeconds);
  if (!p.hysteresis) rule.slack = rule.restSlack = 0.0F;
}

}  // namespace pleinair::styles
