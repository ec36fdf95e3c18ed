#include "pipeline/styles/painterly/painterly_looks.h"

#include <array>

namespace pleinair::styles {
namespace {

constexpr std::array<Look, 5> kLooks{{
    {"oil", "layers of bristle strokes, from large to small", ""},
    {"impasto", "thick paint put on with a knife, short and bold", R"(
brush = "knife"
stroke_size = 7
length = 5
layers = 3
relief = 4
gloss = 0.2
hue_jitter = 0.05
value_jitter = 0.08
saturation = 1.25
canvas = 0.05
)"},
    {"gouache", "flat, matt and opaque", R"(
brush = "round"
stroke_size = 5
length = 6
opacity = 1
relief = 0.3
gloss = 0
canvas = 0
hue_jitter = 0.015
saturation_jitter = 0.06
value_jitter = 0.03
wash = 1
)"},
    {"pastel", "dry chalk on toned paper, which shines through", R"(
brush = "dry"
support = "paper"
tooth = 0.7
opacity = 0.85
relief = 0
gloss = 0
canvas = 0.2
wash = 0.35
ground_red = 0.62
ground_green = 0.57
ground_blue = 0.5
wander = 0.25
saturation = 1.2
hue_jitter = 0.05
)"},
    {"sketch", "coloured pencils on white paper", R"(
brush = "pencil"
support = "paper"
tooth = 0.8
opacity = 0.75
relief = 0
gloss = 0
canvas = 0.2
wash = 0.1
ground_red = 0.97
ground_green = 0.96
ground_blue = 0.93
wander = 0.15
saturation = 1.1
coverage = 2.5
)"},
}};

}  // namespace

std::span<const Look> painterlyLooks() {
  return kLooks;
}

}  // namespace pleinair::styles
