#pragma once

#include <atomic>
#include <bitset>
#include <cstddef>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "hal/clock.h"
#include "hal/error.h"
#include "hal/key_pressed.h"
#include "hal/keyboards/keyboard_device.h"

namespace pleinair::hal {

/// Which keyboards are read.
struct KeyboardChoice {
  bool all = true;                 ///< every keyboard, and those that are named
  std::vector<std::string> named;  ///< nodes, paths that lead to them, or devices' names
  bool grabs = false;              ///< their keys reach neither the console nor other programs

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
  void devicesChanged() { hasChanged_ = true; }

  /// While another console is in front, whose keys they are: keys are dropped and grabs given up.
  void setPaused(bool on);

  /// How many are read now.
  std::size_t count() const { return open_.size(); }
  /// Appends what has kept keyboards from being read since the last call, once for each.
  void takeProblems(std::vector<Error>& problems);

 private:
  struct Open {
    std::string node;
    std::unique_ptr<KeyboardDevice> device;
    std::bitset<768> held;  ///< by KEY_…
  };
  void look();
  void open(const KeyboardDescription& description);
  bool isChosen(const KeyboardDescription& description) const;
  /// Whether it is still there.
  bool read(Open& keyboard, std::vector<KeyPressed>& keys);
  void accept(Open& keyboard, const KeyEvent& event, std::vector<KeyPressed>& keys);
  bool isHeld(bool shift) const;
  void tell(const std::string& node, Error problem);

  KeyboardChoice choice_;
  KeyboardDevices& devices_;
  const Clock& clock_;
  std::atomic<bool> hasChanged_ = true;
  TimePoint lookedAt_;
  std::vector<Open> open_;
  std::set<std::string> told_;  ///< nodes whose problem was told
  std::vector<Error> problems_;
  bool isPaused_ = false;
};

}  // namespace pleinair::hal
