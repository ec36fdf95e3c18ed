#include "pipeline/styles/painterly/painterly_parameters.h"

namespace pleinair::styles {

using config::choiceParameter;
using config::integerParameter;
using config::numberParameter;
using config::switchParameter;
using P = PainterlyParameters;

const config::ParameterTable<PainterlyParameters>& painterlyParameters() {
  static const config::NumberRange kPart{.min = 0, .max = 1};
  static constexpr std::array<config::Choice<Brush>, 6> kBrushes{{
      {"round", Brush::kRound},
      {"flat", Brush::kFlat},
      {"dry", Brush::kDry},
      {"knife", Brush::kKnife},
      {"marker", Brush::kMarker},
      {"pencil", Brush::kPencil},
  }};
  static const config::ParameterTable<P> table{
      integerParameter("seed", &P::seed, {.min = 0, .max = 1'000'000},
                       "Which of the random paintings; a change starts a new one."),
      numberParameter("stroke_size", &P::strokeSizePixels, {.min = 4, .max = 64, .unit = "px"},
                      "Width of the finest strokes; a change starts a new painting."),
      numberParameter("layer_ratio", &P::layerRatio, {.min = 1.2, .max = 4},
                      "How much wider each coarser layer's strokes are; likewise."),
      numberParameter("coverage", &P::coverage, {.min = 0.5, .max = 12},
                      "How many of a layer's strokes lie over each other; likewise."),
      numberParameter("length", &P::length, {.min = 1, .max = 12, .unit = "widths"},
                      "The most that a stroke is long; likewise."),
      numberParameter("detail", &P::detail, {.min = 0, .max = 2},
                      "How much detail a place has that is painted with fine strokes."),
      numberParameter("middle_detail", &P::middleDetail, {.min = 0, .max = 2},
                      "How much it has for middling ones."),
      numberParameter("colour_threshold", &P::colourThreshold, {.min = 0.01, .max = 1},
                      "The colour difference at which a fine stroke ends (thesis §4.4)."),
      numberParameter("cut_off", &P::cutOffDegrees, {.min = 1, .max = 90, .unit = "degrees"},
                      "The turn between two segments at which a fine stroke ends."),
      numberParameter("wander", &P::wander, {.min = 0, .max = 1, .unit = "rad"},
                      "How far a stroke strays from the direction of things."),
      numberParameter("opacity", &P::opacity, kPart, "Of a stroke's paint."),
      numberParameter("width_variation", &P::widthVariation, kPart,
                      "How much strokes of a layer differ in width."),
      numberParameter("hue_jitter", &P::hueJitter, kPart, "How much strokes differ in hue."),
      numberParameter("saturation_jitter", &P::saturationJitter, kPart, "In saturation."),
      numberParameter("value_jitter", &P::valueJitter, kPart, "And in value."),
      choiceParameter("brush", &P::brush, kBrushes, "What strokes are painted with."),
      numberParameter("relief", &P::relief, {.min = 0, .max = 8},
                      "How high the paint lies in the light; 0 does without."),
      numberParameter("gloss", &P::gloss, kPart, "How much the paint shines."),
      numberParameter("canvas", &P::canvas, kPart, "How much of the canvas's weave is seen."),
      numberParameter("wash", &P::wash, kPart,
                      "How much of the picture is laid under the strokes as a thin wash."),
      numberParameter("ground_red", &P::groundRed, kPart, "The ground's colour: red."),
      numberParameter("ground_green", &P::groundGreen, kPart, "Green."),
      numberParameter("ground_blue", &P::groundBlue, kPart, "Blue."),
      numberParameter("saturation", &P::saturation, {.min = 0, .max = 2}, "Of all paint."),
      numberParameter("warmth", &P::warmth, {.min = -1, .max = 1}, "Likewise; below 0: cold."),
      numberParameter("coherence", &P::coherence, kPart,
                      "How strokes hold on to their past: 0 redraws each frame, 1 never lets go."),
      switchParameter("warp", &P::warp,
                      "Whether strokes go with what they depict; off, they stay on the screen."),
      switchParameter("history", &P::history,
                      "Whether shapes, colours and directions are blended with what they were."),
      switchParameter("hysteresis", &P::hysteresis,
                      "Whether what is there stays a little longer than it would newly come."),
      switchParameter("fades", &P::fades, "Whether strokes come and go gradually."),
  };
  return table;
}

}  // namespace pleinair::styles
