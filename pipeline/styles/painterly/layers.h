#pragma once

#include <cstddef>

#include "pipeline/marks/anchor_set.h"
#include "pipeline/marks/stroke_set.h"
#include "pipeline/styles/painterly/painterly_parameters.h"

namespace pleinair::styles {

inline constexpr std::size_t kLayers = 3;  ///< from coarse to fine
inline constexpr int kQuads = 8;           ///< of a stroke, at most

/// What decides which anchors there are.
struct LayerPlan {
  double strokeSizePixels = 0.0;
  double layerRatio = 0.0;
  double coverage = 0.0;
  double length = 0.0;
  int seed = 0;
  bool operator==(const LayerPlan&) const = default;
};

LayerPlan planOf(const PainterlyParameters& p);

/// Of a layer's strokes, in px of the full picture.
double widthOf(const LayerPlan& plan, std::size_t layer);
/// As many anchors as make the coverage with strokes of full length.
marks::AnchorOptions anchorsOf(const LayerPlan& plan, std::size_t layer);
/// Texels across a layer's brush: about as many as its strokes have pixels.
int texelsOf(const LayerPlan& plan, std::size_t layer);

/// Coarse strokes are straight and broad and stop late, fine ones bend (thesis §4.4).
marks::StrokeRule ruleOf(const PainterlyParameters& p, const LayerPlan& plan, std::size_t layer);

}  // namespace pleinair::styles
