#pragma once

#include <filesystem>
#include <utility>

#include "hal/clock.h"

namespace pleinair::app {

/// How long a rescue picture stays until the service is tried again: each time twice as long while
/// the service keeps failing, so that a machine that cannot paint is not busy with it. What is
/// known of the time before is in a file of the service manager's, which ends with the machine's
/// run. One thread.
class RescueBackOff {
 public:
  static constexpr hal::Duration kLongest = std::chrono::minutes(30);
  /// A service that stayed up for longer has recovered.
  static constexpr hal::Duration kRecovered = std::chrono::minutes(10);

  /// `file` need not exist; where it cannot be read or written, each time is the first.
  explicit RescueBackOff(std::filesystem::path file) : file_(std::move(file)) {}

  /// A rescue picture is shown from now on. Returns for how long. `shortest`: the first time.
  hal::Duration begin(hal::Duration shortest, hal::TimePoint now) const;

 private:
  std::filesystem::path file_;
};

}  // namespace pleinair::app
