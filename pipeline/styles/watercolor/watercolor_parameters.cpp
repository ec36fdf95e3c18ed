#include "pipeline/styles/watercolor/watercolor_parameters.h"

#include <array>

namespace pleinair::styles {

using config::integerParameter;
using config::numberParameter;
using config::switchParameter;
using P = WatercolorParameters;

const config::ParameterTable<WatercolorParameters>& watercolorParameters() {
  static const config::NumberRange kPart{.min = 0, .max = 1};
  static const config::ParameterTable<P> table{
      integerParameter("cell_size", &P::cellSizePixels, {.min = 4, .max = 64, .unit = "px"},
                       "Side of a Voronoi cell; a change starts a new tiling."),
      integerParameter("seed", &P::seed, {.min = 0, .max = 1'000'000},
                       "Which of the random tilings; a change starts a new one."),
      numberParameter("edge_alpha", &P::edgeAlpha, kPart,
                      "Edges: chroma's part beside luma's (thesis eq. 2)."),
      numberParameter("edge_beta", &P::edgeBeta, kPart,
                      "Edges: YUV's part beside RGB's (thesis eq. 4)."),
      numberParameter("edge_threshold", &P::edgeThreshold, kPart,
                      "Edges: the least colour difference that is one (thesis eq. 4)."),
      numberParameter("edge_darkness", &P::edgeDarkness, kPart,
                      "How dark edges are drawn over the washes."),
      integerParameter("retile_pixels", &P::retilePixels, {.min = 1, .max = 4096, .unit = "px"},
                       "The least edge pixels in a cell that pull its seed to them."),
      numberParameter("retile_time", &P::retileTimeSeconds, {.min = 0, .max = 10, .unit = "s"},
                      "Time constant of a seed's way to its edge; 0 jumps, as in the thesis."),
      numberParameter("return_time", &P::returnTimeSeconds, {.min = 0, .max = 60, .unit = "s"},
                      "Time constant of the way to the cell's middle without an edge; 0 stays, as "
                      "in the thesis."),
      numberParameter("retile_rest", &P::retileRest, {.min = 0, .max = 1, .unit = "cells"},
                      "A seed rests until it has this far to go for a while; 0 never rests."),
      numberParameter("edge_softness", &P::edgeSoftness, kPart,
                      "Width of the drawn edge's ramp around the threshold, in thresholds."),
      numberParameter("simplicity", &P::simplicity, {.min = 0.5, .max = 6, .unit = "px"},
                      "How much smaller things than this are smoothed out of shapes."),
      numberParameter("hardness", &P::hardness, kPart,
                      "How sharply washes end where colours differ much."),
      numberParameter("bleeding", &P::bleeding, {.min = 0.3, .max = 3, .unit = "cells"},
                      "How far cells of like colour run together."),
      numberParameter("wobble", &P::wobble, {.min = 0, .max = 16, .unit = "px"},
                      "How far the sides of washes stray from straight lines."),
      numberParameter("rim", &P::rim, kPart, "Pigment that gathers at the rims of dark washes."),
      numberParameter("gaps", &P::gaps, kPart,
                      "Slivers of paper that are left where a wash meets a dark one."),
      numberParameter("granulation", &P::granulation, kPart,
                      "Pigment that settles in the paper's valleys."),
      numberParameter("variation", &P::variation, kPart,
                      "How unevenly the brush is loaded from cell to cell."),
      numberParameter("grain", &P::grain, kPart, "How much of the paper's relief is seen."),
      numberParameter("vividness", &P::vividness, kPart, "Added saturation."),
      numberParameter("luminosity", &P::luminosity, kPart,
                      "How far washes open up towards the white of the paper."),
      numberParameter("mosaic", &P::mosaic, kPart, "How much of the flat cells is seen."),
      numberParameter(
          "filter_time", &P::filterTimeSeconds, {.min = 0, .max = 5, .unit = "s"},
          "Time constant of the picture that edges and colours are taken from, averaged "
          "along its motion; 0 takes each frame as it is."),
      numberParameter("colour_time", &P::colourTimeSeconds, {.min = 0, .max = 5, .unit = "s"},
                      "Time constant of a cell's colours; 0 takes each frame's."),
      switchParameter(
          "movers", &P::movers,
          "Whether what moves by itself has cells of its own, leaves those behind it as they "
          "are, and hides models that it is before."),
  };
  return table;
}

namespace {

constexpr std::array<Look, 4> kLooks{{
    {"line_and_wash", "light washes under a broken line of ink", ""},
    {"glazed", "layers with dried rims and slivers of paper; no line", R"(
edge_darkness = 0
simplicity = 2
rim = 1
gaps = 0.45
granulation = 0.4
variation = 0.6
vividness = 0.4
)"},
    {"wet_in_wet", "large and soft; colours run into each other", R"(
edge_darkness = 0
simplicity = 3.5
hardness = 0.3
bleeding = 2
wobble = 4
rim = 0.3
gaps = 0
granulation = 0.35
variation = 0.8
luminosity = 0.6
)"},
    {"mosaic", "the thesis's: flat Voronoi cells under dark edges", R"(
mosaic = 1
edge_darkness = 0.8
wobble = 0
grain = 0
vividness = 0
luminosity = 0
)"},
}};

}  // namespace

std::span<const Look> watercolorLooks() {
  return kLooks;
}

}  // namespace pleinair::styles
