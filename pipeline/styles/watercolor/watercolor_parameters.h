#pragma once

#include <span>

#include "config/parameter_table.h"
#include "pipeline/styles/style.h"

namespace pleinair::styles {

/// The parameters of the style, with their defaults. The first group is the thesis's (chapter
/// III); with `mosaic` 1, `retile_rest` 0 and the rest of the second group 0 the picture is the
/// thesis's: flat cells under dark edges.
struct WatercolorParameters {
  int cellSizePixels = 8;
  int seed = 1;
  double edgeAlpha = 0.5;
  double edgeBeta = 0.5;
  double edgeThreshold = 0.07;
  double edgeDarkness = 0.5;
  int retilePixels = 4;
  double retileTimeSeconds = 0.1;
  double returnTimeSeconds = 1.0;
  double retileRest = 0.3;

  double edgeSoftness = 0.5;
  double simplicity = 1.5;
  double hardness = 1.0;
  double bleeding = 0.75;
  double wobble = 2.0;
  double rim = 0.5;
  double gaps = 0.2;
  double granulation = 0.3;
  double variation = 0.4;
  double grain = 0.2;
  double vividness = 0.3;
  double luminosity = 0.5;
  double mosaic = 0.0;
  double filterTimeSeconds = 0.3;
  double colourTimeSeconds = 0.3;
  bool movers = true;
};

const config::ParameterTable<WatercolorParameters>& watercolorParameters();

/// The watercolor's looks; the first is what the defaults are.
std::span<const Look> watercolorLooks();

}  // namespace pleinair::styles
