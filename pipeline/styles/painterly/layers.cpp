#include "pipeline/styles/painterly/layers.h"

#include <algorithm>
#include <cmath>

#include <glm/trigonometric.hpp>

#include "pipeline/styles/painterly/coherence.h"
#include "pipeline/styles/strokes/brushes.h"

namespace pleinair::styles {
namespace {

/// Lengths are given for pictures of so many (640x480).
constexpr double kReferencePixels = 307200.0;
constexpr double kMinPixels = 3.0;
/// Strokes of half the width and a third of the length, in more layers.
constexpr float kFaithfulFactor = 13.0F;

std::size_t countOf(const PainterlyParameters& p) {
  return static_cast<std::size_t>(p.layers);
}

/// From how much detail on a layer is painted; the coarsest is everywhere.
double minDetail(const PainterlyParameters& p, std::size_t layer) {
  if (layer == 0) return -1.0;
  if (layer + 1 == countOf(p)) return p.detail;
  const double part = static_cast<double>(layer - 1) / static_cast<double>(countOf(p) - 2);
  return p.middleDetail * std::pow(p.detail / p.middleDetail, part);
}

/// Where a layer is painted: not below what it is for, nor where finer strokes hide it.
glm::vec2 bandOf(const PainterlyParameters& p, std::size_t layer) {
  // Denser fine strokes hide more.
  const double hidden = p.accents ? 4.0 : 6.0;
  return {minDetail(p, layer), layer + 1 < countOf(p) ? hidden * minDetail(p, layer + 1) : 1e9};
}

/// From the middle of a layer's strokes to what is beside them, px; 0 without accents.
float besideOf(const LayerPlan& plan, std::size_t layer) {
  constexpr double kWidths = 1.1;
  return plan.hasAccents ? static_cast<float>(kWidths * widthOf(plan, layer)) : 0.0F;
}

}  // namespace

LayerPlan planOf(const PainterlyParameters& p, hal::FrameSize full) {
  const double scale = std::sqrt(static_cast<double>(full.pixels()) / kReferencePixels);
  // Below that a brush has no bristles to show.
  const double finest =
      std::max(scale * p.strokeSizePixels, std::min(kMinPixels, p.strokeSizePixels));
  return {countOf(p), finest, p.layerRatio, p.coverage, p.length, p.seed, p.accents};
}

double widthOf(const LayerPlan& plan, std::size_t layer) {
  return plan.finestPixels *
         std::pow(plan.layerRatio, static_cast<double>(plan.layers - 1 - layer));
}

marks::AnchorOptions anchorsOf(const LayerPlan& plan, std::size_t layer) {
  const double cell = widthOf(plan, layer) * std::sqrt(2.0 * plan.length / plan.coverage);
  marks::DensityRule density{.cellPixels = std::max(4, static_cast<int>(std::lround(cell)))};
  if (plan.hasAccents && layer + 1 == plan.layers) {
    density.detailFactor = 2.5F;
    density.detailRange = {0.42F, 1.12F};
  }
  if (layer + 1 == plan.layers) density.faithfulFactor = kFaithfulFactor;
  return {.density = density,
          .seed = static_cast<unsigned>(plan.seed) * 8U + static_cast<unsigned>(layer),
          .accentPixels = besideOf(plan, layer)};
}

int texelsOf(const LayerPlan& plan, std::size_t layer) {
  const double wanted = 1.2 * widthOf(plan, layer);
  const auto* const enough =
      std::ranges::find_if(kBrushTexels, [&](int each) { return each >= wanted; });
  return enough != kBrushTexels.end() ? *enough : kBrushTexels.back();
}

marks::StrokeRule ruleOf(const PainterlyParameters& p, const LayerPlan& plan, std::size_t layer,
                         double noiseLevels) {
  const auto width = static_cast<float>(widthOf(plan, layer));
  const auto coarseness = static_cast<float>(plan.layers - 1 - layer);
  marks::StrokeRule rule;
  rule.widthPx = width;
  rule.besidePx = besideOf(plan, layer);
  rule.steps = 4.0F;
  rule.bothWays = p.walk == StrokeWalk::kBoth;
  const float arms = rule.bothWays ? 2.0F : 1.0F;
  rule.segmentPx = static_cast<float>(p.length) * width / (arms * rule.steps);
  rule.colourThreshold = static_cast<float>(p.colourThreshold) * (1.0F + 0.6F * coarseness);
  rule.cutOffRad = glm::radians(static_cast<float>(p.cutOffDegrees)) / (1.0F + 0.4F * coarseness);
  rule.detailBand = bandOf(p, layer);
  rule.modelDetail = static_cast<float>(p.modelDetail);
  rule.detailSpread = 0.6F * std::max(rule.detailBand.x, 0.0F);
  rule.wanderRad = static_cast<float>(p.wander) * (1.0F + 0.3F * coarseness);
  rule.looseness = static_cast<float>(p.looseness);
  rule.fieldLevel = plan.layers - 1 - layer;
  rule.widthSpread = static_cast<float>(p.widthVariation);
  rule.opacity = static_cast<float>(p.opacity);
  rule.leaveLight = static_cast<float>(p.leaveLight);
  rule.jitter = {static_cast<float>(p.hueJitter), static_cast<float>(p.saturationJitter),
                 static_cast<float>(p.valueJitter)};
  rule.quads = kQuads;
  rule.layer = static_cast<int>(layer);
  rule.layers = static_cast<int>(plan.layers);
  rule.clips = p.clip;
  holdOn(rule, p, noiseLevels);
  return rule;
}

}  // namespace pleinair::styles
