#include "pipeline/runtime/status/runtime_status.h"

#include <algorithm>

namespace pleinair::runtime {

bool RuntimeStatus::isHealthy() const {
  const auto takes = [](const OutputStage::Status& output) {
    return !output.isFailed && (output.perSecond > 0.0 || output.suspension);
  };
  return camera.state == hal::CameraState::kStreaming && painting.hasPainter &&
         std::ranges::all_of(outputs, takes);
}

}  // namespace pleinair::runtime
