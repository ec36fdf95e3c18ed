#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hal/error.h"

namespace pleinair::hal {

/// An input device with keys or buttons, as the kernel describes it.
struct KeyboardDescription {
  std::string node;         ///< "/dev/input/event3"
  std::string name;         ///< "AT Translated Set 2 keyboard"
  bool isKeyboard = false;  ///< has the letters of one; a pedal or a power button has not
  bool hasKeys = true;      ///< has keys; a mouse or a gamepad has buttons only
  /// Vendor and product in hexadecimal, "05f3:00ff": the same at any socket, and for all nodes of a
  /// device. Empty where the kernel knows none.
  std::string id;
};

/// A key of a device went down (1) or up (0), or repeats (2).
struct KeyEvent {
  unsigned code = 0;  ///< KEY_… of linux/input-event-codes.h
  int value = 0;
};

/// An open input device. One thread.
class KeyboardDevice {
 public:
  virtual ~KeyboardDevice() = default;
  KeyboardDevice() = default;
  KeyboardDevice(const KeyboardDevice&) = delete;
  KeyboardDevice& operator=(const KeyboardDevice&) = delete;

  /// Reads the next key. Never waits: false where there is none. After an overrun of the kernel's
  /// buffer the keys whose state differs from what was read come as events. Errors: kDeviceLost,
  /// kIo, after which only destruction is allowed.
  virtual Answer read(KeyEvent& event) = 0;
  /// Whether other readers, the console among them, get its events too. Errors: kBusy, kIo.
  virtual Result<void> setGrabbed(bool on) = 0;
};

/// The input devices of a machine; tests replace it. One thread.
class KeyboardDevices {
 public:
  virtual ~KeyboardDevices() = default;
  KeyboardDevices() = default;
  KeyboardDevices(const KeyboardDevices&) = delete;
  KeyboardDevices& operator=(const KeyboardDevices&) = delete;

  /// Those that have keys or buttons, by node. Opens none and needs no permission.
  virtual std::vector<KeyboardDescription> list() = 0;
  /// The node that a path leads to: of "/dev/input/by-id/usb-…-event-kbd". As it is where it leads
  /// nowhere.
  virtual std::string nodeOf(const std::string& path) = 0;
  /// Errors: kPermissionDenied, kNotFound, kUnsupported (built without libevdev), kIo.
  virtual Result<std::unique_ptr<KeyboardDevice>> open(const std::string& node) = 0;
};

/// The kernel's, through libevdev.
KeyboardDevices& kernelKeyboards();

/// Whether `choice` names the device: its id, its name, its node, or a path that leads to the node.
bool isNamed(const KeyboardDescription& device, const std::string& choice,
             KeyboardDevices& devices);

}  // namespace pleinair::hal
