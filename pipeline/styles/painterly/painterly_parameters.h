#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string>

#include "config/parameter_table.h"
#include "pipeline/styles/strokes/brush_cache.h"
#include "pipeline/styles/strokes/brushes.h"
#include "pipeline/styles/strokes/stroke_strips.h"
#include "pipeline/styles/style.h"
#include "pipeline/styles/substrate/substrate.h"

namespace pleinair::styles {

/// Which way a stroke is grown from its anchor.
enum class StrokeWalk { kBoth, kAhead };

/// Where paint's relief is lit: once, when all is painted, on each stroke by itself, or nowhere.
enum class StrokeBump { kOnce, kEach, kOff };

/// The parameters of the style, with their defaults. Lengths are in px of a full
/// picture of 640x480.
struct PainterlyParameters {
  int seed = 1;
  int layers = 4;
  double strokeSizePixels = 4.0;  // the finest layer's width, of a picture of 640x480
  double layerRatio = 2.0;        // each coarser layer's strokes are wider by this
  double coverage = 3.5;          // strokes of a layer that lie over each other
  double length = 8.0;            // of a stroke, in widths
  double detail = 0.32;           // from which fine strokes are painted
  double middleDetail = 0.08;
  double modelDetail = 2.5;
  double colourThreshold = 0.11;
  double colourClip = 1.0;
  double cutOffDegrees = 45.0;
  double wander = 0.12;
  double looseness = 0.8;  // of fast movers
  double focus = 0.0;
  double focusX = 0.5;
  double focusY = 0.5;
  double focusRadius = 0.25;
  double focusFalloff = 0.25;
  double faces = 1.0;  // how much more exactly they are painted than the rest
  double opacity = 1.0;
  double leaveLight = 0.0;
  double widthVariation = 0.25;
  double hueJitter = 0.05;
  double saturationJitter = 0.18;
  double valueJitter = 0.11;
  std::filesystem::path brushFile = kNoBrushFile;
  Brush brush = Brush::kFlat;
  double relief = 1.5;
  double gloss = 0.08;
  Substrate::Kind support = Substrate::Kind::kLinen;
  double canvas = 0.15;
  double tooth = 0.0;
  double wash = 0.95;
  double groundRed = 0.55;
  double groundGreen = 0.45;
  double groundBlue = 0.35;
  std::string palette = "all";
  double saturation = 1.27;
  double warmth = 0.15;
  double coherence = 0.5;
  double memorySeconds = 0.65;  // of a stroke's colour, shape and directions (thesis §5.4)
  StrokeWalk walk = StrokeWalk::kBoth;
  StrokeBump bump = StrokeBump::kOnce;
  StrokeQuads quads = StrokeQuads::kCurvature;
  bool warp = true;
  bool history = true;
  bool hysteresis = true;
  bool fades = true;
  bool movers = true;
  bool segments = false;
  bool clip = true;
  bool accents = true;
  bool modelSpace = true;
};

const config::ParameterTable<PainterlyParameters>& painterlyParameters();

/// The painter's looks; the first is what the defaults are.
std::span<const Look> painterlyLooks();

}  // namespace pleinair::styles
