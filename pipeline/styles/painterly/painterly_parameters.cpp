#include "pipeline/styles/painterly/painterly_parameters.h"

#include <array>

#include "pipeline/styles/painterly/palette.h"

namespace pleinair::styles {

using config::choiceParameter;
using config::integerParameter;
using config::numberParameter;
using config::pathParameter;
using config::switchParameter;
using config::TakesEffect;
using config::textParameter;
using P = PainterlyParameters;

const config::ParameterTable<PainterlyParameters>& painterlyParameters() {
  static const config::NumberRange kPart{.min = 0, .max = 1};
  static constexpr std::array<config::Choice<Brush>, kBrushes.size()> kBrushNames{{
      {"round", Brush::kRound},
      {"flat", Brush::kFlat},
      {"dry", Brush::kDry},
      {"knife", Brush::kKnife},
      {"marker", Brush::kMarker},
      {"pencil", Brush::kPencil},
  }};
  static constexpr std::array<config::Choice<StrokeWalk>, 2> kWalks{
      {{"both", StrokeWalk::kBoth}, {"ahead", StrokeWalk::kAhead}}};
  static constexpr std::array<config::Choice<StrokeBump>, 3> kBumps{
      {{"once", StrokeBump::kOnce}, {"each", StrokeBump::kEach}, {"off", StrokeBump::kOff}}};
  static constexpr std::array<config::Choice<StrokeQuads>, 2> kQuadCounts{
      {{"curvature", StrokeQuads::kCurvature}, {"thesis", StrokeQuads::kThesis}}};
  static constexpr std::array<config::Choice<Substrate::Kind>, 2> kSupports{{
      {"linen", Substrate::Kind::kLinen},
      {"paper", Substrate::Kind::kPaper},
  }};
  static const config::ParameterTable<P> table{
      integerParameter("seed", &P::seed, {.min = 0, .max = 1'000'000},
                       "Which of the random paintings; a change starts a new one."),
      integerParameter("layers", &P::layers, {.min = 1, .max = 5},
                       "How many layers, from broad to fine; a change starts a new painting."),
      numberParameter("stroke_size", &P::strokeSizePixels, {.min = 2, .max = 32, .unit = "px"},
                      "Width of the finest strokes in a picture of 640x480; they grow with the "
                      "picture. A change starts a new painting."),
      numberParameter(
          "layer_ratio", &P::layerRatio, {.min = 1.2, .max = 4},
          "How much wider each coarser layer's strokes are; a change starts a new painting."),
      numberParameter("coverage", &P::coverage, {.min = 0.5, .max = 12},
                      "How many of a layer's strokes lie over each other; a change starts a new "
                      "painting."),
      numberParameter("length", &P::length, {.min = 1, .max = 16, .unit = "widths"},
                      "The most that a stroke is long; a change starts a new painting."),
      numberParameter("detail", &P::detail, {.min = 0.01, .max = 2},
                      "How much detail a place has that is painted with fine strokes."),
      numberParameter("middle_detail", &P::middleDetail, {.min = 0.01, .max = 2},
                      "How much detail a place has that is painted with middling strokes."),
      numberParameter("model_detail", &P::modelDetail, {.min = 0.1, .max = 10},
                      "How much more detail counts on models than on what the camera sees."),
      numberParameter("colour_threshold", &P::colourThreshold, {.min = 0.01, .max = 1},
                      "The colour difference at which a fine stroke ends (thesis §4.4)."),
      numberParameter(
          "colour_clip", &P::colourClip, kPart,
          "How much strokes of models and of what moves leave out what is of quite another "
          "colour, such as eyes."),
      numberParameter("cut_off", &P::cutOffDegrees, {.min = 1, .max = 90, .unit = "degrees"},
                      "The turn between two segments at which a fine stroke ends."),
      numberParameter("wander", &P::wander, {.min = 0, .max = 1, .unit = "rad"},
                      "How far a stroke strays from the direction of things."),
      numberParameter("looseness", &P::looseness, kPart,
                      "How much looser fast movers are painted: with fewer fine strokes, and along "
                      "their motion."),
      numberParameter("focus", &P::focus, kPart,
                      "How much more broadly everything outside the picture's focus is painted."),
      numberParameter("focus_x", &P::focusX, kPart,
                      "Where the focus is: 0 left, 1 right. A scene can have foci of its own."),
      numberParameter("focus_y", &P::focusY, kPart, "Where the focus is: 0 top, 1 bottom."),
      numberParameter("focus_radius", &P::focusRadius, {.min = 0, .max = 2},
                      "Radius of the focus, in heights of the picture."),
      numberParameter("focus_falloff", &P::focusFalloff, {.min = 0, .max = 2},
                      "How wide its border is, in heights of the picture."),
      numberParameter("faces", &P::faces, kPart,
                      "How much more exactly than the rest faces are painted; 0 does not look for "
                      "any."),
      numberParameter("opacity", &P::opacity, kPart, "How opaque a stroke's paint is."),
      numberParameter("leave_light", &P::leaveLight, kPart,
                      "How much light places are left to the ground, as pencils do."),
      numberParameter("width_variation", &P::widthVariation, kPart,
                      "How much strokes of a layer differ in width."),
      numberParameter("hue_jitter", &P::hueJitter, kPart, "How much strokes differ in hue."),
      numberParameter("saturation_jitter", &P::saturationJitter, kPart,
                      "How much strokes differ in saturation."),
      numberParameter("value_jitter", &P::valueJitter, kPart, "How much strokes differ in value."),
      choiceParameter("brush", &P::brush, kBrushNames, "What strokes are painted with."),
      pathParameter("brush_file", &P::brushFile, {kNoBrushFile},
                    "A brush of your own instead: a PNG (docs/painting.md).",
                    config::TakesEffect::kLive, ".png"),
      numberParameter("relief", &P::relief, {.min = 0, .max = 8},
                      "How high the paint lies in the light; 0 does without."),
      numberParameter("gloss", &P::gloss, kPart, "How much the paint shines."),
      choiceParameter("support", &P::support, kSupports, "What the picture is painted on."),
      numberParameter("canvas", &P::canvas, kPart, "How much of the support's grain light shows."),
      numberParameter("tooth", &P::tooth, kPart,
                      "How much the support's grain breaks the paint: dry chalk, pencils."),
      numberParameter("wash", &P::wash, kPart,
                      "How much of the picture is laid under the strokes as a thin wash."),
      numberParameter("ground_red", &P::groundRed, kPart, "The ground's colour: red."),
      numberParameter("ground_green", &P::groundGreen, kPart, "The ground's colour: green."),
      numberParameter("ground_blue", &P::groundBlue, kPart, "The ground's colour: blue."),
      textParameter("palette", &P::palette, kPaletteAllowed,
                    "The pigments that strokes are mixed of.", TakesEffect::kLive, isPalette),
      numberParameter("saturation", &P::saturation, {.min = 0, .max = 2},
                      "How saturated all paint is: 1 as the camera sees it."),
      numberParameter("warmth", &P::warmth, {.min = -1, .max = 1},
                      "How warm all paint is; below 0: cold."),
      numberParameter("coherence", &P::coherence, kPart,
                      "How strokes hold on to their past: 0 redraws each frame, 1 never lets go."),
      numberParameter(
          "memory", &P::memorySeconds, {.min = 0, .max = 10, .unit = "s"},
          "The time constant with which colours, shapes and directions of strokes follow "
          "the frames, at coherence 0.5: 0.65 is the thesis's weight of 0.95 on the past "
          "at 30 frames a second, 0.0111 its weight of 0.05 (figure 40)."),
      choiceParameter("walk", &P::walk, kWalks,
                      "Which way strokes grow from their anchors; ahead only is the thesis's."),
      choiceParameter(
          "bump", &P::bump, kBumps,
          "The paint's relief is lit once, or, as the thesis does, on each stroke, or not."),
      choiceParameter("quads", &P::quads, kQuadCounts,
                      "What strokes are drawn of: as few as they bend, or the thesis's 4 (n + 2)."),
      switchParameter("warp", &P::warp,
                      "Whether strokes go with what they depict; off, they stay on the screen."),
      switchParameter("history", &P::history,
                      "Whether shapes, colours and directions are blended with what they were."),
      switchParameter("hysteresis", &P::hysteresis,
                      "Whether what is there stays a little longer than it would newly come."),
      switchParameter("fades", &P::fades, "Whether strokes come and go gradually."),
      switchParameter("movers", &P::movers,
                      "Whether what moves by itself is told from the background."),
      switchParameter("segments", &P::segments,
                      "Whether strokes end at the borders of the camera image's segments."),
      switchParameter("accents", &P::accents,
                      "Whether what is narrow is kept: more strokes begin on it and follow it, and "
                      "they lie over those beside it. A change starts a new painting."),
      switchParameter(
          "clip", &P::clip,
          "Whether strokes and their colours end where models, their patches and movers "
          "do (thesis §5.5, figure 41)."),
      switchParameter("model_space", &P::modelSpace,
                      "Whether models carry the strokes that are on them; off, they are painted as "
                      "part of the camera's image, whose motion is not theirs."),
  };
  return table;
}

namespace {

constexpr std::array<Look, 6> kLooks{{
    {"oil", "layers of bristle strokes, from large to small", ""},
    {"impasto", "thick paint, put on in short bold strokes that catch the light", R"(
saturation_jitter = 0.12
layers = 3
stroke_size = 5.5
layer_ratio = 1.8
length = 7
detail = 0.35
brush = "round"
relief = 2.6
gloss = 0.12
hue_jitter = 0.05
value_jitter = 0.08
saturation = 1.35
canvas = 0.05
)"},
    {"gouache", "flat, matt and opaque", R"(
accents = false
saturation = 1.25
layers = 3
stroke_size = 3.4
detail = 0.2
layer_ratio = 2.2
length = 6
opacity = 1
brush = "marker"
support = "paper"
canvas = 0.06
relief = 0.25
gloss = 0
hue_jitter = 0.03
saturation_jitter = 0.14
value_jitter = 0.15
wash = 1
warmth = 0.05
)"},
    {"pastel", "dry chalk on toned paper, which shines through", R"(
accents = false
saturation_jitter = 0.12
stroke_size = 3.5
length = 7
layers = 3
brush = "dry"
support = "paper"
tooth = 0.8
opacity = 1
relief = 0
gloss = 0
canvas = 0.4
wash = 0.85
ground_red = 0.62
ground_green = 0.55
ground_blue = 0.47
wander = 0.22
saturation = 1.25
hue_jitter = 0.05
value_jitter = 0.2
)"},
    {"sketch", "coloured pencils on white paper", R"(
hue_jitter = 0.03
saturation_jitter = 0.12
value_jitter = 0.05
layers = 2
stroke_size = 3
layer_ratio = 1.7
length = 12
middle_detail = 0.05
detail = 0.12
colour_clip = 0
coverage = 3
brush = "pencil"
support = "paper"
tooth = 0.55
leave_light = 0.65
opacity = 0.75
relief = 0
gloss = 0
canvas = 0.1
wash = 0.2
ground_red = 0.97
ground_green = 0.955
ground_blue = 0.92
wander = 0.1
saturation = 1.2
warmth = 0
)"},
    {"ink", "brown ink on white paper, washed with a brush and drawn with it", R"(
hue_jitter = 0.03
saturation_jitter = 0.12
value_jitter = 0.05
saturation = 1.12
layers = 3
stroke_size = 3
layer_ratio = 1.7
length = 12
middle_detail = 0.05
detail = 0.12
colour_clip = 0
coverage = 4
brush = "round"
palette = "sepia"
support = "paper"
tooth = 0.15
leave_light = 1
opacity = 0.75
relief = 0
gloss = 0
canvas = 0.1
wash = 0.4
ground_red = 0.97
ground_green = 0.955
ground_blue = 0.92
wander = 0.1
warmth = 0
)"},
}};

}  // namespace

std::span<const Look> painterlyLooks() {
  return kLooks;
}

}  // namespace pleinair::styles
