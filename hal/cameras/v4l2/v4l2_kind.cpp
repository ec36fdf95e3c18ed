#include "hal/cameras/v4l2/v4l2_kind.h"

#include "hal/cameras/v4l2/v4l2_backend.h"

namespace pleinair::hal::v4l2 {

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
