#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "hal/captured_frame.h"
#include "hal/clock.h"

namespace pleinair::hal::captures {

/// What a camera said about a frame beside its pixels.
struct FrameFacts {
  Duration time{0};  ///< capture time since the stream began
  std::uint64_t droppedBefore = 0;
  std::uint64_t underrunsBefore = 0;
  LinkCounts linkBefore;
  TimestampSource timestampSource = TimestampSource::kArrival;
  std::optional<Duration> deviceTime;
  FrameHealth health = FrameHealth::kValid;
  friend bool operator==(const FrameFacts&, const FrameFacts&) = default;
};

/// Those of a frame of a stream that began at `start`.
FrameFacts factsOf(const CapturedFrame& frame, TimePoint start);

/// A line such as "time=40000000 dropped=1 source=arrival health=valid": a number is in ns or
/// counts, and what is 0 or unset is left out, but for the time.
std::string textOf(const FrameFacts& facts);
/// Reads such a line. Words that it does not know are skipped, so that older programs read newer
/// recordings. Nothing if a value is broken, or the time is missing or not within 100 years.
std::optional<FrameFacts> parseFacts(std::string_view text);

}  // namespace pleinair::hal::captures
