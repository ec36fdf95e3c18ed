#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hal/camera_backend.h"
#include "hal/camera_kind.h"
#include "hal/cameras/v4l2/device_nodes.h"
#include "hal/cameras/v4l2/v4l2_camera.h"

namespace pleinair::hal::v4l2 {

/// The V4L2 devices of this computer. Ids: hal/cameras/v4l2/find_device.h; make() also takes a
/// node's path, such as "/dev/video0".
class V4l2Backend final : public CameraBackend {
 public:
  explicit V4l2Backend(System system = kernelSystem(), V4l2Options options = {})
      : system_(system), options_(options) {}

  std::string_view name() const override { return "v4l2"; }
  Result<std::vector<CameraDescription>> list() override;
  std::unique_ptr<Camera> make(const std::string& id, Clock& clock) override;
  Result<OfferedModes> offeredModes(const std::string& id, const StreamRequest& request) override;

 private:
  System system_;
  V4l2Options options_;
};

/// V4L2 devices. Its table has where frames lie and the mains' frequency; size, rate and the other
/// controls are those of all cameras.
const CameraKind& cameraKind();

}  // namespace pleinair::hal::v4l2
