#include "hal/surface_pattern.h"

#include <algorithm>
#include <span>
#include <string>

namespace pleinair::hal {
namespace {

std::string colourText(std::span<const std::uint8_t> rgb) {
  return "(" + std::to_string(rgb[0]) + ", " + std::to_string(rgb[1]) + ", " +
         std::to_string(rgb[2]) + ")";
}

}  // namespace

Result<void> checkSurfacePattern(const ImageView& seen, SurfaceId surface) {
  constexpr std::size_t kPatternPixelBytes = 4;
  for (int y = 0; y < seen.format.size.height; ++y) {
    const std::span<const std::uint8_t> row = seen.row(0, y);
    for (int x = 0; x < seen.format.size.width; ++x) {
      const std::array<std::uint8_t, 3> wanted = surfacePatternAt(x, y, surface);
      const auto pixel =
          row.subspan(static_cast<std::size_t>(x) * kPatternPixelBytes, wanted.size());
      if (std::ranges::equal(pixel, wanted)) continue;
      return tl::unexpected(Error{
          .kind = ErrorKind::kUnsupported,
          .subject = "GPU",
          .problem = "what it draws into the display's memory arrives wrong: " + colourText(pixel) +
                     " for " + colourText(wanted) + " at " + std::to_string(x) + ", " +
                     std::to_string(y),
          .remedy = {}});
    }
  }
  return {};
}

}  // namespace pleinair::hal
