#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/camera_backend.h"
#include "hal/error.h"
#include "hal/outputs/v4l2_loopback/loopback_devices.h"
#include "hal/supervisor/camera_selector.h"

namespace pleinair::app {

/// The cameras of all back ends that are devices.
struct DeviceCameras {
  std::vector<hal::CameraDescription> cameras;
  std::vector<hal::Error> problems;  ///< of back ends that failed to list their cameras
};

DeviceCameras listDeviceCameras(std::span<const hal::SelectableBackend> backends);

/// A connector of a graphics card, as the kernel lists it.
struct Display {
  std::string name;  ///< "card0-HDMI-A-1"
  bool isConnected = false;
  std::vector<std::string> modes;  ///< "1920x1080", the preferred one first, each size once
};

/// Lists the connectors in `folder`, which is /sys/class/drm; empty if the folder does not exist.
std::vector<Display> listDisplays(const std::filesystem::path& folder = "/sys/class/drm");

/// The available cameras and outputs.
struct Inventory {
  DeviceCameras cameras;
  std::vector<hal::LoopbackDevice> loopbacks;
  std::vector<Display> displays;
  std::optional<hal::Error> noWindow;  ///< the reason why no window can be opened, if any
};

/// Text for the terminal: a line per device, its formats below. An empty list says so and gives the
/// next step.
std::string asText(const Inventory& inventory);

/// JSON for programs: {"cameras": [{"backend", "id", "name", "serial", "node", "formats":
/// [{"layout", "width", "height", "rates", "read"} …], "problem"} …], "outputs": {"loopbacks":
/// [{"node", "card", "driver", "writable", "layouts", "problem"} …], "displays": [{"name",
/// "connected", "modes"} …], "window"}, "problems": [text …]}; "problem" is null if there is none.
std::string asJson(const Inventory& inventory);

}  // namespace pleinair::app
