#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/camera_backend.h"
#include "hal/error.h"
#include "hal/keyboards/keyboard_device.h"
#include "hal/output_kind.h"
#include "hal/supervisor/camera_selector.h"

namespace pleinair::app {

/// The cameras of all back ends that are devices.
struct DeviceCameras {
  std::vector<hal::CameraDescription> cameras;
  std::vector<hal::Error> problems;  ///< of back ends that failed to list their cameras
};

DeviceCameras listDeviceCameras(std::span<const hal::SelectableBackend> backends);

/// Adds the modes of each camera and the one that it would take for the request, or its problem.
/// `backends`: as for listDeviceCameras(). Opens the cameras.
void askModes(DeviceCameras& cameras, std::span<const hal::SelectableBackend> backends,
              const hal::StreamRequest& request);

/// The outputs of a kind that are there, or how files of it are named.
struct KindOfOutputs {
  std::string kind;
  std::string help;
  std::vector<std::string> forms;  ///< as of hal::OutputKind
  bool isFile = false;
  hal::OutputListing listing;  ///< empty for files
};

std::vector<KindOfOutputs> listOutputs(std::span<const hal::OutputKind> kinds);

/// A keyboard or pedal, for [input] keyboards.
struct ListedKeyboard {
  hal::KeyboardDescription description;
  std::optional<hal::Error> problem;  ///< why it cannot be opened
};

/// Those of the machine, keyboards first. Opens each.
std::vector<ListedKeyboard> listKeyboards(hal::KeyboardDevices& devices);

/// The cameras, outputs and keyboards of this machine.
struct Inventory {
  DeviceCameras cameras;
  std::vector<KindOfOutputs> outputs;
  std::vector<ListedKeyboard> keyboards;
  /// What cameras were asked for, if they were: the inventory is of cameras alone then.
  std::optional<hal::StreamRequest> asked;
};

/// Text for the terminal: a line per device, its formats below. An empty list says so and gives the
/// next step.
std::string asText(const Inventory& inventory);

/// For programs: {"cameras": [{"backend", "id", "name", "serial", "node", "formats": [{"layout",
/// "width", "height", "rates", "read"} …], "chosen": {"layout", "width", "height", "rate",
/// "reason"}, "problem"} …], "outputs": [{"kind", "target", "name",
/// "formats", "busy", "scan_out", "problem"} …], "keyboards": [{"node", "name", "keyboard",
/// "problem"} …], "problems": [text …]}; "chosen", its "rate" and
/// "problem" are null where there is none.
std::string asJson(const Inventory& inventory);

}  // namespace pleinair::app
