#pragma once

#include <chrono>
#include <optional>

#include "hal/clock.h"

namespace pleinair::hal {

/// The delays before a lost camera is opened again.
struct BackOffRule {
  Duration first = std::chrono::milliseconds(500);
  Duration maximum = std::chrono::seconds(8);
  double factor = 2.0;
  /// After streaming for so long, the next delay is `first` again.
  Duration resetAfter = std::chrono::seconds(5);
};

/// Delays that grow exponentially from one failure to the next.
class BackOff {
 public:
  explicit BackOff(BackOffRule rule) : rule_(rule), next_(rule.first) {}

  /// Gives the delay after one more failure.
  Duration grow();
  /// Notes that the camera had streamed for `duration` when it was lost.
  void streamed(Duration duration);
  /// Makes the next delay the first one.
  void reset() { next_ = rule_.first; }

 private:
  BackOffRule rule_;
  Duration next_;
};

}  // namespace pleinair::hal
