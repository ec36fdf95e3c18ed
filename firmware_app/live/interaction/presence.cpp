#include "firmware_app/live/interaction/presence.h"

#include <utility>

namespace pleinair::app {

bool Presence::update(const Seen& seen) {
  const bool hasMoved = std::exchange(movedAt_, seen.movedAt) != seen.movedAt;
  const bool isPreparing = seen.movedAt && seen.painted && *seen.painted == 0;
  return seen.anyKey || hasMoved || isPreparing;
}

}  // namespace pleinair::app
