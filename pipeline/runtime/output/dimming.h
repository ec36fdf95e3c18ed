#pragma once

#include <cstdint>

#include "hal/image.h"

namespace pleinair::runtime {

/// A share in 1/256, so that pictures are dimmed by whole numbers.
using Brightness = std::uint32_t;
inline constexpr Brightness kFullBrightness = 256;

/// The nearest one to a share from 0 to 1.
Brightness brightnessOf(double share);

/// Multiplies the colours of an RGBA8 picture into one of the same format; alpha stays. They are
/// multiplied as they are, with their gamma: half of it looks about half as bright. `from` may be
/// `into`'s own view.
void dim(const hal::ImageView& from, Brightness brightness, hal::Image& into);

}  // namespace pleinair::runtime
