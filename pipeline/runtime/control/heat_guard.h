#pragma once

#include <chrono>
#include <cstddef>
#include <optional>

#include "hal/clock.h"

namespace pleinair::runtime {

struct HeatRules {
  std::size_t levels = 1;      ///< number of quality levels; 1: there is nothing to lower
  double marginKelvin = 5.0;   ///< nearer to the machine's limit, quality is lowered; 0: never
  double releaseKelvin = 5.0;  ///< so much beyond the margin, it may rise again
  hal::Duration lowerAfter = std::chrono::seconds(10);
  hal::Duration raiseAfter = std::chrono::minutes(1);
};

/// Lowers the quality before a hot machine slows itself down, which would cost frames: by a level
/// each time that the machine has been too hot for `lowerAfter`, and back by one each time that it
/// has been cool for `raiseAfter`. Between both margins all stays as it is. One thread.
class HeatGuard {
 public:
  explicit HeatGuard(HeatRules rules) : rules_(rules) {}

  /// To be called with each reading. `marginKelvin`: from the temperature to the limit; unset:
  /// there is no sensor, or none any more. `level`: the quality level in force (0: the best), which
  /// the painter's load may have lowered further. Returns whether best() changes.
  bool update(std::optional<double> marginKelvin, std::size_t level, hal::TimePoint now);

  /// The best level that the heat permits.
  std::size_t best() const { return best_; }
  /// Once it has been too hot for `lowerAfter`, until it is cool and all levels are permitted.
  bool isHot() const { return isHot_; }

 private:
  bool tooHot(std::size_t level, hal::TimePoint now);
  bool cool(hal::TimePoint now);

  HeatRules rules_;
  std::size_t best_ = 0;
  bool isHot_ = false;
  std::optional<hal::TimePoint> hotSince_;   ///< or since the last level that was taken away
  std::optional<hal::TimePoint> coolSince_;  ///< or since the last one that was given back
};

}  // namespace pleinair::runtime
