#include "hal/cameras/v4l2/chronology.h"

#include <algorithm>
#include <chrono>

#include <linux/videodev2.h>

namespace pleinair::hal::v4l2 {
namespace {

constexpr Duration kMaxAhead = std::chrono::milliseconds(100);

/// The difference of two 32-bit counters that wrap; a difference of at least half the range counts
/// as a step backwards.
std::uint32_t framesBetween(std::uint32_t last, std::uint32_t next) {
  const std::uint32_t step = next - last;
  return step == 0 || step > 0x7FFFFFFF ? 0 : step - 1;
}

TimestampSource sourceOf(std::uint32_t flags) {
  const bool isStart = (flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  return isStart ? TimestampSource::kStartOfExposure : TimestampSource::kEndOfReadout;
}

}  // namespace

void Chronology::stamp(const Filled& filled, bool wasStarving, TimePoint now,
                       CapturedFrame& frame) {
  frame.droppedBefore =
      lastDeviceSequence_ ? framesBetween(*lastDeviceSequence_, filled.sequence) : 0;
  frame.underrunsBefore = wasStarving ? frame.droppedBefore : 0;
  frame.sequence = nextSequence_ + frame.droppedBefore;
  lastDeviceSequence_ = filled.sequence;
  nextSequence_ = frame.sequence + 1;

  const bool isMonotonic =
      (filled.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  const TimePoint deviceTime(filled.timestamp);
  const bool isSet = filled.timestamp > Duration::zero();
  const bool rises = !lastDeviceTime_ || deviceTime > *lastDeviceTime_;
  const bool isTrusted = isMonotonic && isSet && rises && deviceTime <= now + kMaxAhead;
  frame.captureTime = isTrusted ? std::min(deviceTime, now) : now;
  frame.timestampSource = isTrusted ? sourceOf(filled.flags) : TimestampSource::kArrival;
  if (isTrusted) lastDeviceTime_ = deviceTime;
  if (isSet) frame.deviceTime = filled.timestamp;
  if (lastTime_) frame.captureTime = std::max(frame.captureTime, *lastTime_ + Duration(1));
  lastTime_ = frame.captureTime;
}

}  // namespace pleinair::hal::v4l2
