#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "pipeline/procedure/step_command.h"

namespace pleinair::app {

/// The commands of the buttons of a pedal, gamepad, presenter or keyboard.
struct MappedDevice {
  std::string device;  ///< as hal::ButtonDevice::device
  std::string label;   ///< the name that people know it by; may be empty
  bool grabs = true;
  std::map<unsigned, procedure::StepCommand> buttons;  ///< by KEY_… or BTN_…
};

/// Inputs that lead through a procedure without hands on a keyboard.
///
///     [[device]]
///     device = "05f3:00ff"          # vendor:product, a name, or a path below /dev/input
///     label = "VEC Footpedal"       # optional
///     grab = true                   # optional; its events reach no other program
///     buttons = { BTN_LEFT = "back", BTN_RIGHT = "next" }
///
///     [cards]                       # ids of tags of the scene's family
///     570 = "next"
///     571 = "operator J. Müller"
struct InputMap {
  std::vector<MappedDevice> devices;
  std::map<int, procedure::StepCommand> cards;

  bool isEmpty() const { return devices.empty() && cards.empty(); }
};

/// Throws config::ConfigError, with file and line, for a file that cannot be read, an unknown key,
/// button or command, a device that is there twice, and a file without any of them.
InputMap readInputMap(const std::filesystem::path& file);

/// The text of such a file.
std::string inputMapText(const InputMap& map);

}  // namespace pleinair::app
