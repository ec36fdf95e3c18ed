#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "hal/clock.h"
#include "hal/error.h"
#include "hal/keyboards/input_devices.h"
#include "hal/keyboards/keyboard_device.h"

namespace pleinair::hal {

/// A pedal, gamepad, presenter or keyboard that is read button by button.
struct ButtonDevice {
  std::string device;  ///< id, name, node, or a path that leads to the node
  bool grabs = true;   ///< its events reach neither the desktop nor the console
};

/// A button or key went down.
struct ButtonPressed {
  std::size_t device = 0;  ///< index of the ButtonDevice
  unsigned code = 0;       ///< KEY_… or BTN_… of linux/input-event-codes.h
  friend bool operator==(const ButtonPressed&, const ButtonPressed&) = default;
};

/// The buttons of chosen devices, which come and go. The kernel's devices (evdev) are read
/// directly: libinput, and with it every desktop, ignores pedals that are neither keyboard nor
/// mouse. One thread, but for devicesChanged().
class Buttons {
 public:
  /// Opens nothing yet. The references outlive this.
  Buttons(std::vector<ButtonDevice> chosen, KeyboardDevices& devices, const Clock& clock);
  Buttons(const Buttons&) = delete;
  Buttons& operator=(const Buttons&) = delete;

  /// Appends the presses since the last call, at most kMaxPressed; what is more is dropped, as are
  /// repeats of held keys, and everything while paused. Never waits. Looks for devices that have
  /// come as InputDevices does.
  void take(std::vector<ButtonPressed>& pressed);
  static constexpr std::size_t kMaxPressed = 16;

  void devicesChanged() { devices_.devicesChanged(); }
  void setPaused(bool on) { devices_.setPaused(on); }
  void takeProblems(std::vector<Error>& problems) { devices_.takeProblems(problems); }
  void takeChanges(std::vector<InputDevices::Change>& changes) { devices_.takeChanges(changes); }

 private:
  std::vector<ButtonDevice> chosen_;
  InputDevices devices_;
};

/// "KEY_PAGEDOWN", "BTN_LEFT"; a number where the code has no name, or in builds without libevdev.
std::string buttonName(unsigned code);
/// The code of a name, or of a number in decimal; nothing for another text.
std::optional<unsigned> buttonNamed(const std::string& name);
/// The code of a number in decimal, below 768.
std::optional<unsigned> buttonNumbered(const std::string& text);

}  // namespace pleinair::hal
