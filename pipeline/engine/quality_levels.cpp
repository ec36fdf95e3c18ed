#include "pipeline/engine/quality_levels.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pleinair {
namespace {

// Each has little more than half of the pixels of the one above: what does not follow the size
// costs as much at all of them.
constexpr std::array<QualityPlan, 4> kPlans{{
    {.name = "full", .help = "painted at the picture's own size", .side = 1.0},
    {.name = "medium", .help = "painted at 0.75 of its sides", .side = 0.75},
    {.name = "low", .help = "painted at 0.56 of its sides", .side = 0.56},
    {.name = "lowest", .help = "painted at 0.42 of its sides", .side = 0.42},
}};

int sideAt(int full, double part) {
  if (part == 1.0) return full;
  const int even = 2 * static_cast<int>(std::lround(0.5 * part * full));
  return std::clamp(even, 1, full);
}

}  // namespace

std::span<const QualityPlan> qualityPlans() {
  return kPlans;
}

hal::FrameSize sizeAt(hal::FrameSize full, const QualityPlan& plan) {
  return {sideAt(full.width, plan.side), sideAt(full.height, plan.side)};
}

}  // namespace pleinair
