#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/camera_backend.h"
#include "hal/error.h"
#include "hal/output_kind.h"
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

/// The outputs of a kind that are there, or how files of it are named.
struct KindOfOutputs {
  std::string kind;
  std::string help;
  std::vector<std::string> forms;  ///< as of hal::OutputKind
  bool isFile = false;
  hal::OutputListing listing;  ///< empty for files
};

std::vector<KindOfOutputs> listOutputs(std::span<const hal::OutputKind> kinds);

/// What is there to paint from and to.
struct Inventory {
  DeviceCameras cameras;
  std::vector<KindOfOutputs> outputs;
  std::vector<Display> displays;
};

/// For people: a line a device, its formats below; empty lists say so and what to do.
std::string asText(const Inventory& inventory);

/// For programs: {"cameras": [{"backend", "id", "name", "serial", "node", "formats": [{"layout",
/// "width", "height", "rates", "read"} …], "problem"} …], "outputs": [{"kind", "target", "name",
/// "formats", "busy", "problem"} …], "displays": [{"name", "connected", "modes"} …], "problems":
/// [text …]}; "problem" is null where there is none.
std::string asJson(const Inventory& inventory);

}  // namespace pleinair::app
