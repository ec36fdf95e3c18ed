#pragma once

#include <cstdint>

#include "hal/cameras/synthetic/world/builder.h"

namespace pleinair::hal::synthetic {

// Surface materials. Colours are sRGB-coded 0xRRGGBB.

/// One colour with slight variation.
Painter plain(std::uint32_t srgb);
/// Painted sheet metal: one colour, with bright, worn edges.
Painter enamel(std::uint32_t srgb);
/// Ground steel, streaked along x, with a soft highlight across.
Painter steel(std::uint32_t srgb = 0xb4b8ba);
/// The side of a polished cylinder: bright and dark bands along its axis.
Painter polished(std::uint32_t srgb);
/// A wooden board, with the grain along x or along y.
Painter board(std::uint32_t srgb, std::uint32_t seed, bool alongY = false);
/// Bands of two colours along x, such as a motor's fins; `period` in metres.
Painter striped(std::uint32_t srgb, std::uint32_t between, float period, float share);
/// Bands of two colours along y.
Painter ringed(std::uint32_t srgb, std::uint32_t between, float period, float share);
/// Corrugated cardboard with a strip of tape.
Painter cardboard();

/// A sleeve, folded across its length (y).
Painter cloth(std::uint32_t srgb);

/// One painter's result with another one's over it.
Painter layered(Painter below, Painter above);

}  // namespace pleinair::hal::synthetic
