#include "pipeline/engine/quality_levels.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pleinair {
namespace {

constexpr std::array<QualityPlan, 5> kPlans{{
    {.name = "full", .help = "painted at the picture's own size", .side = 1.0},
    {.name = "high", .help = "painted at 0.85 of its sides", .side = 0.85},
    {.name = "medium", .help = "painted at 0.7 of its sides", .side = 0.7},
    {.name = "low", .help = "painted at 0.55 of its sides", .side = 0.55},
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
