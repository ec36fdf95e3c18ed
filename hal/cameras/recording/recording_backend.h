#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hal/camera_backend.h"
#include "hal/cameras/recording/recording.h"

namespace pleinair::hal {

/// Recordings as cameras; ids are their paths, as of openRecording(). It lists none: which of a
/// computer's files are meant, nobody but their owner knows.
class RecordingBackend final : public CameraBackend {
 public:
  explicit RecordingBackend(RecordingOptions options) : options_(options) {}

  std::string_view name() const override { return "recording"; }
  Result<std::vector<CameraDescription>> list() override {
    return std::vector<CameraDescription>();
  }
  std::unique_ptr<Camera> make(const std::string& id, Clock& clock) override;

 private:
  RecordingOptions options_;
};

}  // namespace pleinair::hal
