#pragma once

#include "hal/camera_backend.h"
#include "hal/cameras/synthetic/synthetic_camera.h"

namespace pleinair::hal {

/// The synthetic camera's shots as cameras; ids are their names ("walkaround"), the options' shot
/// is the first. A name that no shot has becomes a camera whose start() says what there is.
class SyntheticBackend final : public CameraBackend {
 public:
  explicit SyntheticBackend(SyntheticOptions options) : options_(options) {}

  std::string_view name() const override { return "synthetic"; }
  Result<std::vector<CameraDescription>> list() override;
  std::unique_ptr<Camera> make(const std::string& id, Clock& clock) override;

 private:
  SyntheticOptions options_;
};

}  // namespace pleinair::hal
