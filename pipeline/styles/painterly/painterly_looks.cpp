#include "pipeline/styles/painterly/painterly_looks.h"

#include <array>

namespace pleinair::styles {
namespace {

constexpr std::array<Look, 6> kLooks{{
    {"oil", "layers of bristle strokes, from large to small", ""},
    {"impasto", "thick paint, put on in short bold strokes that catch the light", R"(
layers = 3
stroke_size = 6
layer_ratio = 1.8
length = 7
detail = 0.35
brush = "round"
relief = 2.6
gloss = 0.12
hue_jitter = 0.05
value_jitter = 0.08
saturation = 1.25
canvas = 0.05
)"},
    {"gouache", "flat, matt and opaque", R"(
layers = 3
stroke_size = 4
detail = 0.2
layer_ratio = 2.2
length = 6
opacity = 1
brush = "marker"
support = "paper"
canvas = 0.06
relief = 0.25
gloss = 0
hue_jitter = 0.012
saturation_jitter = 0.06
value_jitter = 0.03
wash = 1
warmth = 0.05
)"},
    {"pastel", "dry chalk on toned paper, which shines through", R"(
stroke_size = 4.5
length = 7
layers = 3
brush = "dry"
support = "paper"
tooth = 0.5
opacity = 0.85
relief = 0
gloss = 0
canvas = 0.2
wash = 0.5
ground_red = 0.62
ground_green = 0.55
ground_blue = 0.47
wander = 0.22
saturation = 1.25
hue_jitter = 0.05
value_jitter = 0.07
)"},
    {"sketch", "coloured pencils on white paper", R"(
layers = 2
stroke_size = 3
layer_ratio = 1.7
length = 12
middle_detail = 0.05
detail = 0.12
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
layers = 3
stroke_size = 3
layer_ratio = 1.7
length = 12
middle_detail = 0.05
detail = 0.12
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
