#include "pipeline/styles/painterly/layers.h"

#include <algorithm>
#include <cmath>

#include <glm/trigonometric.hpp>

#include "pipeline/styles/painterly/coherence.h"

namespace pleinair::styles {
namespace {

/// Where a layer is painted: not below what it is for, nor where finer strokes hide it.
glm::vec2 bandOf(const PainterlyParameters& p, std::size_t layer) {
  switch (layer) {
    case 0:
      return {-1.0, 3.0 * p.detail};
    case 1:
      return {p.middleDetail, 8.0 * p.detail};
    default:
      return {p.detail, 1e9};
  }
}

}  // namespace

LayerPlan planOf(const PainterlyParameters& p) {
  return {p.strokeSizePixels, p.layerRatio, p.coverage, p.length, p.seed};
}

double widthOf(const LayerPlan& plan, std::size_t layer) {
  return plan.strokeSizePixels *
         std::pow(plan.layerRatio, static_cast<double>(kLayers - 1 - layer));
}

marks::AnchorOptions anchorsOf(const LayerPlan& plan, std::size_t layer) {
  const double cell = widthOf(plan, layer) * std::sqrt(2.0 * plan.length / plan.coverage);
  return {.density = {.cellPixels = std::max(4, static_cast<int>(std::lround(cell)))},
          .seed = static_cast<unsigned>(plan.seed) * 8U + static_cast<unsigned>(layer)};
}

int texelsOf(const LayerPlan& plan, std::size_t layer) {
  const double width = widthOf(plan, layer);
  int texels = 8;
  while (texels < width * 1.2 && texels < 64) texels *= 2;
  return texels;
}

marks::StrokeRule ruleOf(const PainterlyParameters& p, const LayerPlan& plan, std::size_t layer) {
  const auto width = static_cast<float>(widthOf(plan, layer));
  const auto coarseness = static_cast<float>(kLayers - 1 - layer);
  marks::StrokeRule rule;
  rule.widthPx = width;
  rule.steps = 4.0F;
  rule.segmentPx = static_cast<float>(p.length) * width / (2.0F * rule.steps);
  rule.colourThreshold = static_cast<float>(p.colourThreshold) * (1.0F + 0.6F * coarseness);
  rule.cutOffRad = glm::radians(static_cast<float>(p.cutOffDegrees)) / (1.0F + 0.4F * coarseness);
  rule.detailBand = bandOf(p, layer);
  rule.detailSpread = 0.6F * std::max(rule.detailBand.x, 0.0F);
  rule.wanderRad = static_cast<float>(p.wander) * (1.0F + 0.3F * coarseness);
  rule.fieldLevel = kLayers - 1 - layer;
  rule.widthSpread = static_cast<float>(p.widthVariation);
  rule.opacity = static_cast<float>(p.opacity);
  rule.jitter = {static_cast<float>(p.hueJitter), static_cast<float>(p.saturationJitter),
                 static_cast<float>(p.valueJitter)};
  rule.quads = kQuads;
  holdOn(rule, p);
  return rule;
}

}  // namespace pleinair::styles
