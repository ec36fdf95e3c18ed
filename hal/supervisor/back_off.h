#pragma once

#include <chrono>
#include <optional>

#include "hal/clock.h"

namespace pleinair::hal {

/// How long to wait before a lost camera is opened again.
struct BackOffRule {
  Duration first = std::chrono::milliseconds(500);
  Duration maximum = std::chrono::seconds(8);
  double factor = 2.0;
  /// After streaming for this long, the next wait is the first one again.
  Duration resetAfter = std::chrono::seconds(5);
};

/// Waits that grow from one failure to the next.
class BackOff {
 public:
  explicit BackOff(BackOffRule rule) : rule_(rule), next_(rule.first) {}

  /// The wait after one more failure.
  Duration grow();
  /// It had streamed for `duration` when it was lost.
  void streamed(Duration duration);
  /// The world has changed: the next wait is the first one.
  void reset() { next_ = rule_.first; }

 private:
  BackOffRule rule_;
  Duration next_;
};

}  // namespace pleinair::hal
