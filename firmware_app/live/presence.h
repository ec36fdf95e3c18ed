#pragma once

#include <cstdint>
#include <optional>

#include "hal/clock.h"

namespace pleinair::app {

/// What keeps displays on that are switched off while nobody is there (blanking): a key, a movement
/// before the camera, and a first painting that is yet to come. One thread.
class Presence {
 public:
  /// What is known of the live painting.
  struct Seen {
    bool anyKey = false;                     ///< since the last call
    std::optional<hal::TimePoint> movedAt;   ///< the last movement; the camera's first frame is one
    std::optional<std::uint64_t> painted{};  ///< frames so far; unset: no painter is being made yet
  };

  /// Whether somebody counts as being there since the last call. From the camera's first frame to
  /// the first painting always, which is not to come to a display that is off.
  bool update(const Seen& seen);

 private:
  std::optional<hal::TimePoint> movedAt_;
};

}  // namespace pleinair::app
