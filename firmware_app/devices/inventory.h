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

/// The cameras that are devices, of all back ends.
struct DeviceCameras {
  std::vector<hal::CameraDescription> cameras;
  std::vector<hal::Error> problems;  ///< of back ends that could not list theirs
};

DeviceCameras listDeviceCameras(std::span<const hal::SelectableBackend> backends);

/// A connector of a graphics card, as the kernel lists it.
struct Display {
  std::string name;  ///< "card0-HDMI-A-1"
  bool isConnected = false;
  std::vector<std::string> modes;  ///< "1920x1080", the preferred one first; of one size once
};

/// Those in `folder`, which is /sys/class/drm; nothing where there is no such folder.
std::vector<Display> listDisplays(const std::filesystem::path& folder = "/sys/class/drm");

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
