#include "hal/cameras/recording/recording_backend.h"

namespace pleinair::hal {

std::unique_ptr<Camera> RecordingBackend::make(const std::string& id, Clock& clock) {
  return openRecording(id, clock, options_);
}

}  // namespace pleinair::hal
