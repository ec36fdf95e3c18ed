#include "pipeline/styles/watercolor/watercolor_looks.h"

#include <array>

namespace pleinair::styles {
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
