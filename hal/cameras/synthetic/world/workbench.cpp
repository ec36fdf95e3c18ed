#include "hal/cameras/synthetic/world/workbench.h"

#include <utility>

#include "hal/cameras/synthetic/world/figure.h"

namespace pleinair::hal::synthetic {

namespace {

constexpr double kFiguresLitAtX = 0.35;  // about the middle of their way

}  // namespace

Plan planWorkbench(std::uint32_t seed) {
  Builder builder;
  buildRoom(builder);
  buildBench(builder, seed);
  buildMachines(builder);
  buildClutter(builder);
  buildArm(builder);
  buildFigures(builder, {visitorPose(0, kFiguresLitAtX), visitorPose(1, kFiguresLitAtX)});
  return std::move(builder.plan());
}

}  // namespace pleinair::hal::synthetic
