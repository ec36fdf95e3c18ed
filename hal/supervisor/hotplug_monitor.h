#pragma once

#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "hal/error.h"

namespace pleinair::hal {

/// The kernel's news of a device that was plugged or unplugged, or changed.
struct DeviceEvent {
  std::string action;     ///< "add", "remove", "change" …
  std::string subsystem;  ///< "video4linux", "usb"
  std::string node;       ///< "/dev/video0"; empty where it has none
};

/// Where such news come from.
class DeviceEvents {
 public:
  virtual ~DeviceEvents() = default;
  DeviceEvents() = default;
  DeviceEvents(const DeviceEvents&) = delete;
  DeviceEvents& operator=(const DeviceEvents&) = delete;

  /// Waits for the next event. Errors: kIo, after which nothing more comes; kNotFound once it was
  /// interrupted.
  virtual Result<DeviceEvent> next() = 0;
  /// next() returns, now and from then on. Any thread.
  virtual void interrupt() = 0;
};

/// udev's, of cameras' subsystems. Errors: kUnsupported (built without udev), kIo (no udev here).
Result<std::unique_ptr<DeviceEvents>> udevEvents();

/// Tells of each event on a thread of its own, such as to a CameraSupervisor's devicesChanged().
/// Without one, or once its events fail, cameras are found again all the same, if later: by the
/// supervisor's back-off alone.
class HotplugMonitor {
 public:
  /// `changed` is called on the monitor's thread, until the destructor.
  HotplugMonitor(std::unique_ptr<DeviceEvents> events,
                 std::function<void(const DeviceEvent&)> changed);
  ~HotplugMonitor();
  HotplugMonitor(const HotplugMonitor&) = delete;
  HotplugMonitor& operator=(const HotplugMonitor&) = delete;

 private:
  std::unique_ptr<DeviceEvents> events_;
  std::function<void(const DeviceEvent&)> changed_;
  std::thread thread_;  // last: it uses the rest
};

}  // namespace pleinair::hal
