#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/clock.h"
#include "hal/error.h"
#include "hal/key_pressed.h"
#include "hal/keyboards/input_devices.h"
#include "hal/keyboards/keyboard_device.h"

namespace pleinair::hal {

/// Which keyboards are read.
struct KeyboardChoice {
  bool all = true;                  ///< every keyboard, and those that are named
  std::vector<std::string> named;   ///< nodes, paths that lead to them, or devices' names or ids
  std::vector<std::string> except;  ///< in the same forms: what is read elsewhere
  bool grabs = false;               ///< their keys reach neither the console nor other programs

  /// "auto" (all), "none", or nodes, paths and names with commas between them. Nothing where a name
  /// is empty or too long.
  static std::optional<KeyboardChoice> parsed(std::string_view text);
};

/// The keys of keyboards without a desktop, which come and go: the keys of KeyPressed, by their
/// places on a US keyboard. Modifiers count over all keyboards. Held keys repeat as the kernel has
/// them (EV_REP). A keyboard that cannot be read is left out. One thread, but for devicesChanged().
class Keyboards {
 public:
  /// Opens nothing yet. The references outlive this.
  Keyboards(KeyboardChoice choice, KeyboardDevices& devices, const Clock& clock);

  /// Appends the keys since the last call, at most kMaxKeys; what is more is dropped. Never waits.
  /// Looks for keyboards that have come: once devicesChanged() was called, and every 5 s.
  void takeKeys(std::vector<KeyPressed>& keys);
  static constexpr std::size_t kMaxKeys = 64;

  /// Keyboards may have come or gone. Any thread.
  void devicesChanged() { devices_.devicesChanged(); }

  /// While another console is in front, whose keys they are: keys are dropped and grabs given up.
  void setPaused(bool on) { devices_.setPaused(on); }

  /// How many are read now.
  std::size_t count() const { return devices_.open().size(); }
  /// Appends what has kept keyboards from being read since the last call, once for each.
  void takeProblems(std::vector<Error>& problems) { devices_.takeProblems(problems); }

 private:
  void accept(const KeyEvent& event, std::vector<KeyPressed>& keys);
  bool isHeld(bool shift) const;

  InputDevices devices_;
};

}  // namespace pleinair::hal
