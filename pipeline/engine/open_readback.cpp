#include "pipeline/engine/open_readback.h"

namespace pleinair {

void OpenReadback::submit(const gpu::Texture& picture, hal::FrameSize size, Stamp stamp) {
  stamp.surface = std::exchange(next, std::nullopt);
  if (stamp.surface) {
    drawer->submit(picture, size, stamp.surface->id);
  } else if (ring.hasRoom()) {
    ring.submit(picture, size);
  } else {
    ++skipped;
    return;
  }
  inFlight.push_back(stamp);
}

hal::Answer OpenReadback::isReadyWithin(hal::Duration limit) const {
  return inFlight.front().surface ? drawer->isReadyWithin(limit) : ring.isReadyWithin(limit);
}

hal::Answer OpenReadback::take(OutputFrame& frame,
                               hal::Answer (present::Readback::*copy)(hal::Image&),
                               hal::Duration limit) {
  frame.surface.reset();
  const bool isDrawn = !inFlight.empty() && inFlight.front().surface;
  if (!isDrawn) return (ring.*copy)(frame.image);
  const hal::Answer isReady = drawer->isReadyWithin(limit);
  if (isReady.hasError() || !isReady.isYes()) return isReady;
  drawer->pop();
  frame.surface = inFlight.front().surface;
  return true;
}

}  // namespace pleinair
