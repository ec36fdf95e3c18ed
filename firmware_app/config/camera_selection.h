#pragma once

#include <memory>
#include <string>
#include <vector>

#include "firmware_app/config/configuration.h"
#include "hal/clock.h"
#include "hal/supervisor/camera_selector.h"
#include "hal/supervisor/camera_supervisor.h"
#include "hal/supervisor/hotplug_monitor.h"

namespace pleinair::app {

/// The back ends whose cameras are devices, in the order in which "auto" tries them.
std::vector<hal::SelectableBackend> deviceBackends();
/// The same, with the settings of their own tables.
std::vector<hal::SelectableBackend> deviceBackends(const CameraSettings& settings);

/// Makes the selector of camera.source. Its candidates deliver in real time: devices, each on its
/// own driver thread, so that none blocks the program for long; the synthetic camera; and a
/// recording, which is repeated at its own pace. It opens nothing. Throws hal::Failure (kNotFound)
/// if the source is neither a camera's name nor a file. The clock outlives the cameras.
std::unique_ptr<hal::CameraSelector> makeCameraSelector(const CameraSettings& settings,
                                                        hal::Clock& clock);

/// The camera that the settings choose now, stopped. Throws hal::Failure: as above, or why it
/// cannot be opened, with each candidate's reason where there are several.
std::unique_ptr<hal::Camera> chosenCamera(const CameraSettings& settings, hal::Clock& clock);

/// Calls `changed`, on a thread of its own, when a camera or a display is plugged or unplugged,
/// while what is returned lives. Nothing, and `why` set, where udev is not to be had: lost devices
/// are then found again by back-off alone.
std::unique_ptr<hal::HotplugMonitor> watchDevices(
    std::function<void(const hal::DeviceEvent&)> changed, std::string& why);

}  // namespace pleinair::app
