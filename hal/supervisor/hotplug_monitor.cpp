#include "hal/supervisor/hotplug_monitor.h"

#include <utility>

#include <pthread.h>

namespace pleinair::hal {

HotplugMonitor::HotplugMonitor(std::unique_ptr<DeviceEvents> events,
                               std::function<void(const DeviceEvent&)> changed)
    : events_(std::move(events)), changed_(std::move(changed)), thread_([this] {
        pthread_setname_np(pthread_self(), "hotplug");
        while (const Result<DeviceEvent> event = events_->next()) changed_(*event);
      }) {}

HotplugMonitor::~HotplugMonitor() {
  events_->interrupt();
  thread_.join();
}

}  // namespace pleinair::hal
