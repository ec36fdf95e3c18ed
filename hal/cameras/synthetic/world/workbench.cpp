#include "hal/cameras/synthetic/world/workbench.h"

#include <utility>

namespace pleinair::hal::synthetic {

Plan planWorkbench(std::uint32_t seed) {
  Builder builder;
  buildRoom(builder);
  buildBench(builder, seed);
  buildMachines(builder);
  buildClutter(builder);
  buildArm(builder);
  return std::move(builder.plan());
}

}  // namespace pleinair::hal::synthetic
