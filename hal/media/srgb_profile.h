#pragma once

#include <cstdint>
#include <vector>

namespace pleinair::hal {

/// An ICC profile of sRGB (IEC 61966-2-1), by lcms2; the same bytes at each call and on each
/// machine with the same lcms2. Any thread.
const std::vector<std::uint8_t>& srgbProfile();

}  // namespace pleinair::hal
