#pragma once

#include <atomic>
#include <bitset>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "hal/clock.h"
#include "hal/error.h"
#include "hal/keyboards/keyboard_device.h"

namespace pleinair::hal {

/// Input devices that come and go: found, opened, grabbed and read. One that cannot be read is left
/// out. One thread, but for devicesChanged().
class InputDevices {
 public:
  /// What a device was chosen for.
  struct Choice {
    std::size_t index = 0;  ///< of the chooser's own
    bool grabs = false;     ///< its events reach no other program
  };
  /// Nothing: the device is not read.
  using Chooser = std::function<std::optional<Choice>(const KeyboardDescription&)>;

  struct Open {
    std::string node;
    std::string name;
    Choice choice;
    std::unique_ptr<KeyboardDevice> device;
    std::bitset<768> held;  ///< by KEY_… and BTN_…
    bool isGone = false;    ///< while they are read
  };
  /// A device is read from now on, or was pulled out.
  struct Change {
    std::size_t index = 0;  ///< of its choice
    std::string name;
    bool isThere = false;
  };

  /// Opens nothing yet. The references outlive this.
  InputDevices(Chooser chooser, KeyboardDevices& devices, const Clock& clock);

  /// Looks for devices that have come, once devicesChanged() was called and every 5 s; then calls
  /// `accept` with each event since the last call and its device, whose `held` is up to date. Never
  /// waits.
  using Accept = std::function<void(const Open&, const KeyEvent&)>;
  void read(const Accept& accept);

  /// Devices may have come or gone. Any thread.
  void devicesChanged() { hasChanged_ = true; }
  /// Gives grabs up while they are another program's, and takes them again.
  void setPaused(bool on);
  bool isPaused() const { return isPaused_; }

  const std::vector<Open>& open() const { return open_; }
  /// Appends what has kept devices from being read since the last call, once for each.
  void takeProblems(std::vector<Error>& problems);
  /// Appends the devices that have come and gone since the last call.
  void takeChanges(std::vector<Change>& changes);

 private:
  void look();
  void openDevice(const KeyboardDescription& description, const Choice& choice);
  void readDevice(Open& device, const Accept& accept);
  void tell(const std::string& node, Error problem);

  Chooser chooser_;
  KeyboardDevices& devices_;
  const Clock& clock_;
  std::atomic<bool> hasChanged_ = true;
  TimePoint lookedAt_;
  std::vector<Open> open_;
  std::set<std::string> told_;  ///< nodes whose problem was told
  std::vector<Error> problems_;
  std::vector<Change> changes_;
  bool isPaused_ = false;
};

}  // namespace pleinair::hal
