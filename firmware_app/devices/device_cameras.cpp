#include "firmware_app/devices/device_cameras.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace pleinair::app {
DeviceCameras listDeviceCameras(std::span<const hal::SelectableBackend> backends) {
  DeviceCameras all;
  for (const hal::SelectableBackend& each : backends) {
    hal::Result<std::vector<hal::CameraDescription>> cameras = each.backend->list();
    if (cameras) {
      std::ranges::move(*cameras, std::back_inserter(all.cameras));
    } else {
      all.problems.push_back(std::move(cameras.error()));
    }
  }
  return all;
}

}  // namespace pleinair::app
