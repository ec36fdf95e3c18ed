#include "pipeline/styles/watercolor/watercolor_looks.h"

#include <array>

namespace pleinair::styles {
namespace {

constexpr std::array<Look, 2> kLooks{{
    {"line_and_wash", "light washes under a broken line of ink", ""},
    {"wet_in_wet", "no line; colours run together where they are alike", R"(
edge_darkness = 0
bleeding = 1
granulation = 0.7
)"},
}};

}  // namespace

std::span<const Look> watercolorLooks() {
  return kLooks;
}

}  // namespace pleinair::styles
