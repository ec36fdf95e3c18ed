#include "firmware_app/devices/device_cameras.h"

#include <algorithm>
#include <iterator>

namespace pleinair::app {
namespace {

std::vector<std::shared_ptr<hal::CameraBackend>> backends() {
  return {};
}

}  // namespace

DeviceCameras listDeviceCameras() {
  DeviceCameras all;
  for (const auto& backend : backends()) {
    hal::Result<std::vector<hal::CameraDescription>> cameras = backend->list();
    if (cameras) {
      std::ranges::move(*cameras, std::back_inserter(all.cameras));
    } else {
      all.problems.push_back(std::move(cameras.error()));
    }
  }
  return all;
}

}  // namespace pleinair::app
