#pragma once

#include <cstdint>
#include <optional>

#include "hal/clock.h"

namespace pleinair::app {

/// Tells blanking whether somebody is there. A key, a movement before the camera, and a first
/// painting that is yet to come keep a display on. One thread.
class Presence {
 public:
  /// State of the live painting at a call of update().
  struct Seen {
    bool anyKey = false;                     ///< since the last call
    std::optional<hal::TimePoint> movedAt;   ///< the last movement; the camera's first frame is one
    std::optional<std::uint64_t> painted{};  ///< frames so far; unset: no painter is being made yet
  };

  /// Whether somebody counts as being there since the last call. It is always so from the camera's
  /// first frame to the first painting, which must not come to a display that is off.
  bool update(const Seen& seen);

 private:
  std::optional<hal::TimePoint> movedAt_;
};

}  // namespace pleinair::app
