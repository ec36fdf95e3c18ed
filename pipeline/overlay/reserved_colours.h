#pragma once

#include <array>
#include <cstdint>

namespace pleinair::overlay {

/// The colours that are reserved for what is virtual: nothing painted has an edge of both. Signal
/// red, orange, yellow, green and blue are taken: ISO 3864 and ANSI Z535 give them meanings. As
/// shaders/marking.glsl has them.
inline constexpr std::array<std::uint8_t, 3> kReservedRgb{255, 41, 214};
inline constexpr std::array<std::uint8_t, 3> kCasingRgb{26, 0, 23};

}  // namespace pleinair::overlay
