// Replaces udev_events.cpp in builds without libudev.

#include "hal/supervisor/hotplug_monitor.h"

namespace pleinair::hal {

Result<std::unique_ptr<DeviceEvents>> udevEvents() {
  return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                              .subject = "udev",
                              .problem = "is not in this build",
                              .remedy = "install libudev-dev and build anew"});
}

}  // namespace pleinair::hal
