#pragma once

#include <filesystem>
#include <span>

#include "config/parameter_table.h"
#include "pipeline/styles/strokes/brush_cache.h"
#include "pipeline/styles/strokes/brushes.h"
#include "pipeline/styles/style.h"

namespace pleinair::styles {

/// The parameters of the style, with their defaults. Lengths are in px of a full picture of
/// 640x480; they grow with the picture, and in small ones stay above 0.6 times as many.
struct HatchingParameters {
  int seed = 1;
  int directions = 3;
  double spacing = 5.0;
  double length = 64.0;
  double coverage = 2.0;
  double width = 1.7;
  double swell = 0.45;
  double crossDegrees = 62.0;
  double lead = 0.75;  // of the field, beside one slope
  double slopeDegrees = 45.0;
  double evenness = 0.8;
  double wander = 0.07;
  double cutOffDegrees = 35.0;
  double taper = 0.2;
  double opacity = 0.95;
  double darkness = 1.1;
  double gamma = 1.35;
  double lighten = 1.0;     // how much dark pictures are lightened
  double paperTone = 0.06;  // lighter tones are left bare
  bool inverted = false;
  double contours = 1.0;
  double lift = 0.75;
  double contourThreshold = 0.018;
  double contourWidth = 1.3;
  double faces = 1.0;  // how much finer they are drawn than the rest
  Brush brush = Brush::kMarker;
  std::filesystem::path brushFile = kNoBrushFile;
  double grain = 0.15;
  double tooth = 0.1;
  double relief = 0.05;
  double inkRed = 0.08;
  double inkGreen = 0.08;
  double inkBlue = 0.11;
  double colour = 0.0;  // of the picture, in place of the ink's
  double paperRed = 0.97;
  double paperGreen = 0.955;
  double paperBlue = 0.92;
  double shapeTimeSeconds = 2.0;
  double fadeTimeSeconds = 1.0;
  double filterTimeSeconds = 0.3;
  bool movers = true;
};

const config::ParameterTable<HatchingParameters>& hatchingParameters();

/// The first has the defaults' values.
std::span<const Look> hatchingLooks();

}  // namespace pleinair::styles
