#include "pipeline/runtime/control/latency_control.h"

#include <algorithm>
#include <cassert>

namespace pleinair::runtime {
namespace {

/// Fewer frames prove nothing, such as the first one after a lost camera is back.
constexpr std::uint64_t kMinFrames = 3;

}  // namespace

LatencyControl::LatencyControl(LatencyRules rules) : rules_(rules), latency_(rules.configured) {
  assert(rules.maximum >= rules.configured && rules.step > hal::Duration::zero());
}

void LatencyControl::beginWindow(hal::TimePoint now) {
  windowBegan_ = now;
  frames_ = 0;
  lateness_.clear();
}

bool LatencyControl::ready(hal::Duration slack, bool isLowestQuality, hal::TimePoint now) {
  if (!hasWindow_ || isLowestQuality != wasLowest_) {
    if (!hasWindow_) roomSince_ = now;
    hasWindow_ = true;
    wasLowest_ = isLowestQuality;
    beginWindow(now);
  }
  ++frames_;
  if (slack < hal::Duration::zero()) lateness_.add(-slack);
  // The slack has to cover the step and half a step more, so that the next frame is in time too.
  if (slack < rules_.step + rules_.step / 2) roomSince_ = now;
  if (now - windowBegan_ >= rules_.raiseAfter && frames_ >= kMinFrames) {
    const bool misses = 2 * lateness_.count() > frames_;
    const bool changed = isLowestQuality && misses && raise(now);
    beginWindow(now);
    if (changed) return true;
  }
  return now - roomSince_ >= rules_.lowerAfter && lower(now);
}

bool LatencyControl::raise(hal::TimePoint now) {
  const hal::Duration lacking = lateness_.percentile(0.9);
  const auto steps =
      std::max<std::int64_t>(1, (lacking + rules_.step - hal::Duration{1}) / rules_.step);
  const hal::Duration wanted = std::min(latency_ + steps * rules_.step, rules_.maximum);
  if (wanted == latency_) return false;
  latency_ = wanted;
  roomSince_ = now;
  ++raised_;
  return true;
}

bool LatencyControl::lower(hal::TimePoint now) {
  roomSince_ = now;
  if (latency_ == rules_.configured) return false;
  latency_ = std::max(latency_ - rules_.step, rules_.configured);
  ++lowered_;
  return true;
}

}  // namespace pleinair::runtime
