#include "hal/supervisor/session_frames.h"

#include <algorithm>
#include <utility>

namespace pleinair::hal {

FrameCounts FrameCounts::operator+(const FrameCounts& other) const {
  return {.delivered = delivered + other.delivered,
          .dropped = dropped + other.dropped,
          .underruns = underruns + other.underruns,
          .lostInStall = lostInStall + other.lostInStall,
          .corrupt = corrupt + other.corrupt,
          .incomplete = incomplete + other.incomplete,
          .misTimed = misTimed + other.misTimed,
          .link = link + other.link};
}

std::variant<SupervisedFrame, FrameRefusal> SessionFrames::take(CapturedFrame frame, TimePoint now,
                                                                bool isStalled) {
  const std::uint64_t underruns = std::min(frame.underrunsBefore, frame.droppedBefore);
  const std::uint64_t lost = frame.droppedBefore - underruns;
  waiting_.underruns += underruns;
  waiting_.dropped += underruns + (isStalled ? 0 : lost);
  waiting_.lostInStall += isStalled ? lost : 0;
  waiting_.link = waiting_.link + frame.linkBefore;
  if (const auto refusal = refusalOf(frame, now)) {
    switch (*refusal) {
      case FrameRefusal::kCorrupt:
        ++waiting_.corrupt;
        break;
      case FrameRefusal::kIncomplete:
        ++waiting_.incomplete;
        break;
      case FrameRefusal::kMisTimed:
        ++waiting_.misTimed;
        break;
    }
    return *refusal;
  }

  frame.sequence = (counts_ + waiting_).made();
  frame.droppedBefore = waiting_.dropped + waiting_.lostInStall;
  frame.underrunsBefore = waiting_.underruns;
  lastTime_ = frame.captureTime;
  SupervisedFrame taken{.frame = std::move(frame),
                        .lostInStall = waiting_.lostInStall,
                        .corruptBefore = waiting_.corrupt,
                        .incompleteBefore = waiting_.incomplete,
                        .misTimedBefore = waiting_.misTimed};
  waiting_.delivered = 1;
  counts_ = counts_ + waiting_;
  waiting_ = {};
  return taken;
}

std::optional<FrameRefusal> SessionFrames::refusalOf(const CapturedFrame& frame,
                                                     TimePoint now) const {
  if (frame.health == FrameHealth::kIncomplete) return FrameRefusal::kIncomplete;
  if (frame.health == FrameHealth::kCorrupt || !frame.image.isComplete() ||
      (frame.luma && !frame.luma->isComplete())) {
    return FrameRefusal::kCorrupt;
  }
  if (lastTime_ && frame.captureTime <= *lastTime_) return FrameRefusal::kMisTimed;
  // After such a frame all later ones would go back in time.
  if (isDevice_ && frame.captureTime > now + kFutureTolerance) return FrameRefusal::kMisTimed;
  return std::nullopt;
}

}  // namespace pleinair::hal
