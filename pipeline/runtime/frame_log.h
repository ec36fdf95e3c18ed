#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

#include "hal/clock.h"
#include "pipeline/runtime/outcome.h"

namespace pleinair::runtime {

/// What became of a frame at one output.
struct FrameRecord {
  std::size_t output = 0;      ///< which, as FrameLog's users number them
  std::uint64_t sequence = 0;  ///< the camera's
  hal::TimePoint captured;
  hal::TimePoint ready;  ///< when the output frame was complete
  hal::TimePoint due;
  std::optional<std::uint64_t> dueRefresh;  ///< its number; of displays that count them
  Outcome outcome{};
  std::optional<hal::TimePoint> shown;   ///< since when it was on the display
  std::optional<std::uint64_t> refresh;  ///< the number of that refresh
};

/// The records of the frames that outputs got, between the outputs' threads, which must not wait
/// for a disk, and one that writes them. Any thread.
class FrameLog {
 public:
  /// Records that wait; further ones are lost and counted. A few seconds of a fast camera.
  static constexpr std::size_t kCapacity = 4096;

  FrameLog() { records_.reserve(kCapacity); }

  /// Allocates nothing.
  void add(const FrameRecord& record);
  /// Replaces `records` by those since the last call. Returns how many were lost meanwhile.
  std::uint64_t take(std::vector<FrameRecord>& records);

 private:
  std::mutex mutex_;
  std::vector<FrameRecord> records_;
  std::uint64_t lost_ = 0;
};

}  // namespace pleinair::runtime
