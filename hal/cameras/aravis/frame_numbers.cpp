#include "hal/cameras/aravis/frame_numbers.h"

#include <algorithm>
#include <chrono>

namespace pleinair::hal::aravis {
namespace {

/// A frame that is said to be older than this was stamped by a wall clock that jumped.
constexpr Duration kOldest = std::chrono::seconds(1);
constexpr std::uint64_t kShortIds = 65535;  ///< 1 … 65535

}  // namespace

std::uint64_t FrameNumbers::lostSince(std::uint64_t frameId) const {
  if (!lastId_) return 0;
  if (frameId > *lastId_) return frameId - *lastId_ - 1;
  const bool isShort = transport_ == Transport::kGige && *lastId_ <= kShortIds;
  if (!isShort || frameId == 0) return 0;
  const std::uint64_t lost = frameId + kShortIds - *lastId_ - 1;
  return lost < kShortIds / 2 ? lost : 0;  // else it went back
}

void FrameNumbers::stamp(const Filled& filled, const StreamCounts& counts, TimePoint now,
                         CapturedFrame& frame) {
  frame.droppedBefore = lostSince(filled.frameId);
  lastId_ = filled.frameId;
  frame.sequence = nextSequence_ + frame.droppedBefore;
  nextSequence_ = frame.sequence + 1;

  // Aravis may count an underrun some frames before the gap is seen: the frames that were complete
  // by then are still on their way.
  underrunsToTell_ += counts.underruns - counted_.underruns;
  frame.underrunsBefore = std::min(underrunsToTell_, frame.droppedBefore);
  underrunsToTell_ -= frame.underrunsBefore;
  frame.linkBefore = {.missingPackets = counts.missingPackets - counted_.missingPackets,
                      .resentPackets = counts.resentPackets - counted_.resentPackets,
                      .ignoredPackets = counts.ignoredPackets - counted_.ignoredPackets};
  counted_ = counts;

  const bool isPlausible = filled.age && *filled.age >= Duration::zero() && *filled.age <= kOldest;
  frame.captureTime = isPlausible ? now - *filled.age : now;
  frame.timestampSource = TimestampSource::kArrival;
  if (lastTime_) frame.captureTime = std::max(frame.captureTime, *lastTime_ + Duration(1));
  lastTime_ = frame.captureTime;
  if (filled.chunkTime) {
    frame.deviceTime = filled.chunkTime;
  } else if (filled.deviceTime > Duration::zero()) {
    frame.deviceTime = filled.deviceTime;
  }
}

}  // namespace pleinair::hal::aravis
