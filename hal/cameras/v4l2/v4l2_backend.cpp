#include "hal/cameras/v4l2/v4l2_backend.h"

#include "hal/cameras/v4l2/find_device.h"
#include "hal/cameras/v4l2/v4l2_camera.h"

namespace pleinair::hal::v4l2 {

Result<std::vector<CameraDescription>> V4l2Backend::list() {
  return listDevices(system_);
}

std::unique_ptr<Camera> V4l2Backend::make(const std::string& id, Clock& clock) {
  return std::make_unique<V4l2Camera>(id, system_, clock);
}

}  // namespace pleinair::hal::v4l2
