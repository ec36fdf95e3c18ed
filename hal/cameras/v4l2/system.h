#pragma once

#include "hal/cameras/v4l2/device_nodes.h"
#include "hal/v4l2/system_calls.h"

namespace pleinair::hal::v4l2 {

/// What cameras and their listing reach devices through. Both outlive what uses them, frames too.
struct System {
  SystemCalls& calls;
  DeviceNodes& nodes;
};

inline System kernelSystem() {
  return {.calls = kernelCalls(), .nodes = kernelNodes()};
}

}  // namespace pleinair::hal::v4l2
