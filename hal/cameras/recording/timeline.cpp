#include "hal/cameras/recording/timeline.h"

#include <algorithm>

namespace pleinair::hal::recording {
namespace {

constexpr Duration kLargestGlitch = std::chrono::seconds(1);
constexpr Duration kLargestGap = std::chrono::hours(24);
/// Larger timestamps are invalid, and would overflow when subtracted.
constexpr Duration kLargestTime = std::chrono::hours(24 * 365 * 100);

}  // namespace

Duration Timeline::place(std::optional<Duration> time, std::uint64_t droppedBefore) {
  if (time && (*time > kLargestTime || *time < -kLargestTime)) time.reset();
  if (!last_) {
    if (!time) ++corrected_;
    if (!origin_) origin_ = time;
    last_ = Duration::zero();
    return *last_;
  }
  constexpr std::uint64_t kMaxPeriods = 1'000'000;
  const auto periods = static_cast<std::int64_t>(std::min(droppedBefore, kMaxPeriods)) + 1;
  const Duration expected = *last_ + periods * period_;
  // the first valid timestamp, or the first after startOver()
  if (time && !origin_) origin_ = *time - expected;
  const Duration ours = time ? *time - *origin_ : expected;
  if (!time) {
    ++corrected_;
    last_ = expected;
  } else if (ours < *last_ - kLargestGlitch || ours > *last_ + kLargestGap) {
    ++corrected_;
    origin_ = *time - expected;
    last_ = expected;
  } else if (ours <= *last_) {
    ++corrected_;
    last_ = *last_ + std::max(period_ / 2, Duration(1));
  } else {
    last_ = ours;
  }
  return *last_;
}

void Timeline::startOver() {
  origin_.reset();
}

}  // namespace pleinair::hal::recording
