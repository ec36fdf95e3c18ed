#include "pipeline/runtime/latency_control.h"

#include <algorithm>
#include <cassert>

namespace pleinair::runtime {
namespace {

/// Fewer pictures say nothing, such as the first after the camera was away for seconds.
constexpr std::uint64_t kFewest = 3;

}  // namespace

LatencyControl::LatencyControl(LatencyRules rules) : rules_(rules), latency_(rules.configured) {
  assert(rules.maximum >= rules.configured && rules.step > hal::Duration::zero());
}

void LatencyControl::beginWindow(hal::TimePoint now) {
  windowBegan_ = now;
  pictures_ = 0;
  lateness_.clear();
}

bool LatencyControl::ready(hal::Duration slack, bool isLowestQuality, hal::TimePoint now) {
  if (!hasWindow_ || isLowestQuality != wasLowest_) {
    if (!hasWindow_) roomSince_ = now;
    hasWindow_ = true;
    wasLowest_ = isLowestQuality;
    beginWindow(now);
  }
  ++pictures_;
  if (slack < hal::Duration::zero()) lateness_.add(-slack);
  // Room for a step less, and half a step so that the next picture does not miss it.
  if (slack < rules_.step + rules_.step / 2) roomSince_ = now;
  if (now - windowBegan_ >= rules_.raiseAfter && pictures_ >= kFewest) {
    const bool misses = 2 * lateness_.count() > pictures_;
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
