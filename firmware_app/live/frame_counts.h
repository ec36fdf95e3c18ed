#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "hal/clock.h"

namespace pleinair::app {

/// Why a frame that was captured live was not shown.
enum class DropReason {
  kCamera,    ///< the camera had to leave it out
  kReplaced,  ///< a newer one came before it was painted
  kPaused,    ///< it came during a pause
  kStopped,   ///< it was not painted or shown yet when all ended
};

/// What became of each captured frame: under one name each, so that captured() is the sum.
class FrameCounts {
 public:
  void show() { ++shown_; }
  void drop(DropReason reason, std::uint64_t count = 1);

  std::uint64_t shown() const { return shown_; }
  std::uint64_t dropped(DropReason reason) const;
  std::uint64_t dropped() const;
  std::uint64_t captured() const { return shown_ + dropped(); }

  /// "showed 90 frames in 3.0 s (30.0 frames/s); dropped 2: 1 replaced by a newer one, …".
  std::string summary(hal::Duration elapsed) const;

 private:
  static constexpr std::size_t kReasons = 4;
  std::uint64_t shown_ = 0;
  std::array<std::uint64_t, kReasons> dropped_{};
};

}  // namespace pleinair::app
