#pragma once

#include <optional>
#include <string>
#include <vector>

#include "firmware_app/devices/device_cameras.h"
#include "firmware_app/devices/displays.h"
#include "hal/error.h"
#include "hal/outputs/v4l2_loopback/loopback_devices.h"

namespace pleinair::app {

/// What is there to paint from and to.
struct Inventory {
  DeviceCameras cameras;
  std::vector<hal::LoopbackDevice> loopbacks;
  std::vector<Display> displays;
  std::optional<hal::Error> noWindow;  ///< why no window can be opened; unset: it can
};

/// For people: a line a device, its formats below; empty lists say so and what to do.
std::string asText(const Inventory& inventory);

/// For programs: {"cameras": [{"backend", "id", "name", "serial", "node", "formats": [{"layout",
/// "width", "height", "rates", "read"} …], "problem"} …], "outputs": {"loopbacks": [{"node",
/// "card", "driver", "writable", "layouts", "problem"} …], "displays": [{"name", "connected",
/// "modes"} …], "window"}, "problems": [text …]}; "problem" is null where there is none.
std::string asJson(const Inventory& inventory);

}  // namespace pleinair::app
