#pragma once

#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "hal/error.h"

namespace pleinair::hal {

/// An event of a device that was plugged, unplugged or changed.
struct DeviceEvent {
  std::string action;     ///< "add", "remove", "change" …
  std::string subsystem;  ///< "video4linux", "usb", "drm", "input"
  std::string node;       ///< "/dev/video0"; empty if it has none
};

/// A source of device events.
class DeviceEvents {
 public:
  virtual ~DeviceEvents() = default;
  DeviceEvents() = default;
  DeviceEvents(const DeviceEvents&) = delete;
  DeviceEvents& operator=(const DeviceEvents&) = delete;

  /// Waits for the next event. Errors: kIo, after which there are no more events; kNotFound after
  /// interrupt().
  virtual Result<DeviceEvent> next() = 0;
  /// Makes next() return, now and from then on. Any thread.
  virtual void interrupt() = 0;
};

/// Events of the subsystems of cameras, displays and keyboards: the kernel's and udev's. udev's do
/// not reach a process that has no network (a network namespace of its own); the kernel's do, but
/// come before the node has its name and permissions. Hence a kernel's event is reported twice, at
/// once and half a second later. Errors: kUnsupported (built without udev), kIo (no netlink).
Result<std::unique_ptr<DeviceEvents>> udevEvents();

/// Reports each event, for example to CameraSupervisor::devicesChanged(), from its own thread. If
/// there is no monitor, or its source has failed, the supervisor still finds cameras again, but
/// only after its back-off.
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
  std::thread thread_;  // last, because it uses the other members
};

}  // namespace pleinair::hal
