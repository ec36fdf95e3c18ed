#include "hal/outputs/display/drift.h"

namespace pleinair::hal::display {

CanvasOffset driftAt(std::uint64_t step, int pixels) {
  if (pixels <= 0) return {};
  const auto side = static_cast<std::uint64_t>(2 * pixels + 1);
  const std::uint64_t count = side * side;
  // Row by row, every other one from the right; then the same way back.
  const std::uint64_t phase = (count / 2 + step) % (2 * count);
  const std::uint64_t place = phase < count ? phase : 2 * count - 1 - phase;
  const std::uint64_t row = place / side;
  const std::uint64_t column = place % side;
  return {.x = static_cast<int>(row % 2 == 0 ? column : side - 1 - column),
          .y = static_cast<int>(row)};
}

}  // namespace pleinair::hal::display
