#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hal/camera_backend.h"
#include "hal/camera_kind.h"
#include "hal/cameras/libcamera/libcamera_camera.h"
#include "hal/cameras/libcamera/library.h"

namespace pleinair::hal::libcamera {

/// The cameras that libcamera drives, without those on USB: V4L2 has them (hal/cameras/v4l2), with
/// their Motion-JPEG. make() takes any id of libcamera's.
class LibcameraBackend final : public CameraBackend {
 public:
  explicit LibcameraBackend(LibcameraOptions options = {}, Library& library = systemLibrary())
      : options_(options), library_(library) {}

  std::string_view name() const override { return "libcamera"; }
  Result<std::vector<CameraDescription>> list() override;
  std::unique_ptr<Camera> make(const std::string& id, Clock& clock) override;
  Result<OfferedModes> offeredModes(const std::string& id, const StreamRequest& request) override;

 private:
  LibcameraOptions options_;
  Library& library_;
};

/// Sensors by way of libcamera, with the keys of [camera.libcamera].
const CameraKind& cameraKind();

}  // namespace pleinair::hal::libcamera
