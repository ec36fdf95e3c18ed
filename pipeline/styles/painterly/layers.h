#pragma once

#include <cstddef>

#include "hal/pixel_format.h"
#include "pipeline/marks/anchors/anchor_set.h"
#include "pipeline/marks/strokes/stroke_set.h"
#include "pipeline/styles/painterly/painterly_parameters.h"

namespace pleinair::styles {

inline constexpr int kQuads = 8;  ///< of a stroke, at most

/// The values that determine the anchors: another plan is another painting. Layers are counted from
/// the coarsest.
struct LayerPlan {
  std::size_t layers = 0;
  double finestPixels = 0.0;  // a stroke's width, of the full picture
  double layerRatio = 0.0;
  double coverage = 0.0;
  double length = 0.0;
  int seed = 0;
  bool hasAccents = true;  // PainterlyParameters::accents
  bool operator==(const LayerPlan&) const = default;
};

/// Strokes grow with the picture, so that any size takes about as many.
LayerPlan planOf(const PainterlyParameters& p, hal::FrameSize full);

/// The width of a layer's strokes, in px of the full picture.
double widthOf(const LayerPlan& plan, std::size_t layer);
/// Gives a layer as many anchors as reach the coverage with strokes of full length; the finest one
/// more where they are cut short.
marks::AnchorOptions anchorsOf(const LayerPlan& plan, std::size_t layer);
/// Texels across a layer's brush, one of kBrushTexels: about as many as its strokes have pixels.
int texelsOf(const LayerPlan& plan, std::size_t layer);

/// Coarse strokes are straight and broad and stop late, fine ones bend (thesis §4.4).
/// `noiseLevels`: the camera's, in 1/255.
marks::StrokeRule ruleOf(const PainterlyParameters& p, const LayerPlan& plan, std::size_t layer,
                         double noiseLevels);

}  // namespace pleinair::styles
