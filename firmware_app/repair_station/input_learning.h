#pragma once

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "firmware_app/config/input_map.h"
#include "hal/clock.h"
#include "hal/keyboards/input_devices.h"
#include "hal/keyboards/keyboard_device.h"

namespace pleinair::app {

/// Learns an input map: asks for one command after the other, and takes the button that is pressed
/// for it, on any device. One thread.
class InputLearning {
 public:
  /// A command that nobody presses a button for is left out after that time.
  static constexpr hal::Duration kPatience = std::chrono::seconds(10);

  /// The references outlive this.
  InputLearning(std::vector<procedure::StepCommand> commands, hal::KeyboardDevices& devices,
                const hal::Clock& clock);

  /// Reads presses; gives lines for people: what was pressed, and which command is asked for next.
  std::vector<std::string> poll();
  bool isDone() const { return asked_ >= commands_.size(); }
  /// What was learnt. Devices that are keyboards are not grabbed: they write elsewhere, too.
  const InputMap& map() const { return map_; }

 private:
  void look(const hal::KeyboardDescription& device, unsigned code, std::vector<std::string>& lines);
  MappedDevice& mapped(const hal::KeyboardDescription& device);
  void ask(std::vector<std::string>& lines);

  std::vector<procedure::StepCommand> commands_;
  const hal::Clock& clock_;
  std::vector<hal::KeyboardDescription> known_;  ///< by the choice's index
  hal::InputDevices devices_;
  std::size_t asked_ = 0;
  std::optional<hal::TimePoint> since_;  ///< when the command was asked for
  std::set<std::pair<std::string, unsigned>> used_;
  InputMap map_;
};

/// What a device is chosen by in a map: its id, or its name where it has none.
const std::string& selectorOf(const hal::KeyboardDescription& device);

/// Whether a touch on a touchpad or a tablet's pen, which is no button to be mapped.
bool isTouch(unsigned code);

}  // namespace pleinair::app
