#include "hal/cameras/v4l2/v4l2_kind.h"

#include "hal/cameras/v4l2/find_device.h"
#include "hal/cameras/v4l2/v4l2_camera.h"

namespace pleinair::hal::v4l2 {

Result<std::vector<CameraDescription>> V4l2Backend::list() {
  return listDevices(system_);
}

std::unique_ptr<Camera> V4l2Backend::make(const std::string& id, Clock& clock) {
  return std::make_unique<V4l2Camera>(id, system_, clock);
}

const CameraKind& cameraKind() {
  static const CameraKind kKind{
      .name = "v4l2",
      .help = "webcams, capture cards and sensor boards of Linux",
      .naming = CameraNaming::kDevices,
      .defaults = config::ParameterValues(std::make_shared<const config::ParameterList>(
          std::vector<config::ParameterDescriptor>{})),
      .open = [](const config::ParameterValues&, const CameraBackendOptions&)
          -> std::unique_ptr<CameraBackend> { return std::make_unique<V4l2Backend>(); }};
  return kKind;
}

}  // namespace pleinair::hal::v4l2
