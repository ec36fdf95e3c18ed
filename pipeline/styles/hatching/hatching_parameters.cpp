#include "pipeline/styles/hatching/hatching_parameters.h"

#include <array>

namespace pleinair::styles {

using config::choiceParameter;
using config::integerParameter;
using config::numberParameter;
using config::pathParameter;
using config::switchParameter;
using P = HatchingParameters;

const config::ParameterTable<HatchingParameters>& hatchingParameters() {
  static const config::NumberRange kPart{.min = 0, .max = 1};
  static constexpr std::array<config::Choice<Brush>, kBrushes.size()> kBrushNames{{
      {"round", Brush::kRound},
      {"flat", Brush::kFlat},
      {"dry", Brush::kDry},
      {"knife", Brush::kKnife},
      {"marker", Brush::kMarker},
      {"pencil", Brush::kPencil},
  }};
  static const config::ParameterTable<P> table{
      integerParameter("seed", &P::seed, {.min = 0, .max = 1'000'000},
                       "Which of the random drawings; a change starts a new one."),
      integerParameter("directions", &P::directions, {.min = 1, .max = 3},
                       "In how many directions lines cross each other in the darks; a change "
                       "starts a new drawing."),
      numberParameter("spacing", &P::spacing, {.min = 2, .max = 32, .unit = "px"},
                      "Between neighbouring lines where all are drawn; a change starts a new "
                      "drawing."),
      numberParameter("length", &P::length, {.min = 8, .max = 320, .unit = "px"},
                      "The most that a line is long; a change starts a new drawing."),
      numberParameter("coverage", &P::coverage, {.min = 0.5, .max = 6},
                      "How many lines of a direction lie over each other; a change starts a new "
                      "drawing."),
      numberParameter("width", &P::width, {.min = 0.3, .max = 12, .unit = "px"},
                      "Of the widest lines."),
      numberParameter("swell", &P::swell, {.min = 0.05, .max = 1},
                      "Whether tone is made by the number of lines (low) or by their width (1)."),
      numberParameter("cross", &P::crossDegrees, {.min = 10, .max = 90, .unit = "degrees"},
                      "Between the first direction and each of the others."),
      numberParameter("lead", &P::lead, kPart,
                      "How much the things' own directions lead the lines; 0: all at one slope."),
      numberParameter("slope", &P::slopeDegrees, {.min = -90, .max = 90, .unit = "degrees"},
                      "The slope of lines that nothing leads."),
      numberParameter("evenness", &P::evenness, kPart,
                      "How evenly parallel lines are spaced; 0: by chance."),
      numberParameter("wander", &P::wander, {.min = 0, .max = 1, .unit = "rad"},
                      "How far the hand strays."),
      numberParameter("cut_off", &P::cutOffDegrees, {.min = 1, .max = 90, .unit = "degrees"},
                      "The turn between two segments at which a line ends."),
      numberParameter("taper", &P::taper, {.min = 0, .max = 0.5},
                      "The part of a line at each end in which it thins out."),
      numberParameter("opacity", &P::opacity, kPart, "How opaque a line is."),
      numberParameter("darkness", &P::darkness, {.min = 0.2, .max = 4},
                      "How much darker things are drawn than they are."),
      numberParameter("gamma", &P::gamma, {.min = 0.3, .max = 4},
                      "The curve of tones: above 1 lightens the middle ones."),
      numberParameter("lighten", &P::lighten, kPart,
                      "How much dark pictures are lightened, so that their darks are told apart."),
      numberParameter("paper_tone", &P::paperTone, {.min = 0, .max = 0.9},
                      "Lighter tones are left bare."),
      switchParameter("inverted", &P::inverted,
                      "Light lines on a dark ground: they draw what is light."),
      numberParameter("contours", &P::contours, kPart, "How strong contour lines are."),
      numberParameter("lift", &P::lift, kPart,
                      "How bare lines leave the light side of edges, which is seen in the darks."),
      numberParameter("contour_threshold", &P::contourThreshold, {.min = 0.002, .max = 0.3},
                      "The least edge of the picture that is a contour line."),
      numberParameter("contour_width", &P::contourWidth, {.min = 0.5, .max = 4, .unit = "px"},
                      "Of contour lines."),
      numberParameter("faces", &P::faces, kPart,
                      "How much finer than the rest faces are drawn; 0 does not look for any."),
      choiceParameter("brush", &P::brush, kBrushNames, "What lines are drawn with."),
      pathParameter("brush_file", &P::brushFile, {kNoBrushFile},
                    "A brush of your own instead: a PNG (docs/painting.md).",
                    config::TakesEffect::kLive, ".png"),
      numberParameter("grain", &P::grain, kPart, "How much of the brush's own mark is seen."),
      numberParameter("tooth", &P::tooth, kPart,
                      "How much the paper's grain breaks lines: pencil, chalk."),
      numberParameter("relief", &P::relief, kPart, "How much of the paper's relief is seen."),
      numberParameter("ink_red", &P::inkRed, kPart, "The ink's colour: red."),
      numberParameter("ink_green", &P::inkGreen, kPart, "The ink's colour: green."),
      numberParameter("ink_blue", &P::inkBlue, kPart, "The ink's colour: blue."),
      numberParameter("colour", &P::colour, kPart,
                      "How much of the picture's colour lines take, in place of the ink's."),
      numberParameter("paper_red", &P::paperRed, kPart, "The paper's colour: red."),
      numberParameter("paper_green", &P::paperGreen, kPart, "The paper's colour: green."),
      numberParameter("paper_blue", &P::paperBlue, kPart, "The paper's colour: blue."),
      numberParameter("shape_time", &P::shapeTimeSeconds, {.min = 0, .max = 10, .unit = "s"},
                      "Time constant of a line's shape; 0 takes each frame's."),
      numberParameter("fade_time", &P::fadeTimeSeconds, {.min = 0, .max = 5, .unit = "s"},
                      "In which a line comes, or goes that is no longer needed."),
      numberParameter("filter_time", &P::filterTimeSeconds, {.min = 0, .max = 5, .unit = "s"},
                      "Time constant of the picture that tones and contours are taken from, "
                      "averaged along its motion; 0 takes each frame as it is."),
      switchParameter("movers", &P::movers,
                      "Whether what moves by itself is told from the background, whose lines then "
                      "stay as they are behind it."),
  };
  return table;
}

namespace {

constexpr std::array<Look, 6> kLooks{{
    {"pen", "black ink, crossed in the darks", ""},
    {"pencil", "soft grey lines that the paper's tooth breaks", R"(
spacing = 3.6
length = 64
coverage = 2.6
width = 2.6
swell = 0.6
lead = 0.35
cross = 30
evenness = 0.3
wander = 0.14
opacity = 0.66
darkness = 1.2
gamma = 1.0
brush = "pencil"
grain = 0.55
tooth = 0.55
contours = 0.6
contour_width = 1.3
ink_red = 0.2
ink_green = 0.2
ink_blue = 0.22
)"},
    {"engraving", "evenly spaced lines that swell with the tone", R"(
directions = 2
spacing = 4.4
length = 110
coverage = 2.6
width = 2.9
swell = 1
lead = 1
cross = 70
evenness = 1
wander = 0
cut_off = 25
taper = 0.1
darkness = 1.05
gamma = 1.35
shape_time = 5
paper_tone = 0.04
contours = 0.8
contour_width = 1
grain = 0
tooth = 0
relief = 0.03
ink_red = 0.13
ink_green = 0.1
ink_blue = 0.08
)"},
    {"blueprint", "light lines on blue, contours first", R"(
directions = 2
spacing = 6
width = 1.3
swell = 0.35
lead = 0.3
evenness = 1
wander = 0.01
inverted = true
gamma = 1.3
paper_tone = 0.12
contours = 1
contour_width = 1
contour_threshold = 0.014
opacity = 0.65
grain = 0
tooth = 0.1
ink_red = 0.86
ink_green = 0.93
ink_blue = 1
paper_red = 0.07
paper_green = 0.2
paper_blue = 0.45
)"},
    {"chalk", "white chalk on a dark ground, which draws the light", R"(
spacing = 5
length = 60
width = 4
swell = 0.6
lead = 0.6
cross = 40
evenness = 0.2
wander = 0.15
inverted = true
gamma = 1.2
opacity = 0.75
brush = "dry"
grain = 0.5
tooth = 0.75
contours = 0.7
contour_width = 1.6
relief = 0.12
ink_red = 0.95
ink_green = 0.93
ink_blue = 0.88
paper_red = 0.16
paper_green = 0.19
paper_blue = 0.18
)"},
    {"crayon", "soft lines in the picture's own colours", R"(
spacing = 3.8
length = 56
coverage = 2.6
width = 3.4
swell = 0.6
lead = 0.5
cross = 35
evenness = 0.3
wander = 0.12
opacity = 0.72
darkness = 1.25
gamma = 0.8
lighten = 0
paper_tone = 0.03
colour = 1
brush = "pencil"
grain = 0.5
tooth = 0.6
contours = 0.6
lift = 0
contour_width = 1.3
)"},
}};

}  // namespace

std::span<const Look> hatchingLooks() {
  return kLooks;
}

}  // namespace pleinair::styles
