#include "hal/paced_frame.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace pleinair::hal {

NextFrame takePaced(std::optional<CapturedFrame>& pending, Pacing pacing, Clock& clock,
                    TimePoint deadline) {
  assert(pending);
  if (pacing == Pacing::kRealTime && pending->captureTime > clock.now()) {
    clock.sleepUntil(std::min(pending->captureTime, deadline));
    if (pending->captureTime > deadline) return CameraTimeout{};
  }
  return *std::exchange(pending, std::nullopt);
}

}  // namespace pleinair::hal
