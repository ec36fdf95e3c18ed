// Random scripts of cameras, from fixed seeds: the supervisor's answers always keep its contract.

#include <random>

#include <gtest/gtest.h>

#include "tests/unit/hal/supervisor/supervised.h"

namespace pleinair::hal {
namespace {

using std::chrono::milliseconds;
using support::ScriptedFrame;
using support::ScriptedSession;
using support::ScriptedStep;

class RandomScript {
 public:
  explicit RandomScript(unsigned seed) : random_(seed) {}

  ScriptedSession session() {
    ScriptedSession session{.startTakes = milliseconds(upTo(20)), .steps = {}};
    if (upTo(3) == 0) session.startError = support::scriptedError(ErrorKind::kBusy, "is in use");
    session.format.frame = support::scriptedFormat(8 + 2 * upTo(2), 6);
    if (upTo(4) == 0) session.format.framePeriod.reset();
    for (int i = upTo(60); i > 0; --i) session.steps.push_back(step());
    return session;
  }
  int upTo(int most) { return std::uniform_int_distribution<int>(0, most)(random_); }

 private:
  ScriptedStep step() {
    switch (upTo(40)) {
      case 0:
        return CameraLost{support::scriptedError(ErrorKind::kDeviceLost, "was unplugged")};
      case 1:
        return support::scriptedError(ErrorKind::kIo, "EIO");
      case 2:
        return support::ScriptedSilence{milliseconds(upTo(6000))};
      case 3:
        return support::ScriptedJump{milliseconds(upTo(4'000'000))};
      case 4:
        return FormatChanged{{.frame = support::scriptedFormat(16, 2 + upTo(3)),
                              .framePeriod = milliseconds(20 + upTo(60))}};
      default:
        return frame();
    }
  }
  ScriptedFrame frame() {
    ScriptedFrame frame{.after = milliseconds(upTo(60))};  // 0: a time that repeats
    if (upTo(5) == 0) frame.dropped = static_cast<std::uint64_t>(upTo(30));
    if (upTo(2) == 0) frame.underruns = static_cast<std::uint64_t>(upTo(3));
    if (upTo(12) == 0) frame.isTooShort = true;
    if (upTo(12) == 0) frame.timeError = milliseconds(upTo(2000) - 1000);
    return frame;
  }

  std::mt19937 random_;
};

bool mayFollow(CameraState from, CameraState to) {
  using enum CameraState;
  switch (to) {
    case kOpening:
      return from == kBackingOff;
    case kStreaming:
      return from == kOpening || from == kStalled;
    case kStalled:
      return from == kStreaming;
    case kLost:
      return from == kOpening || from == kStreaming || from == kStalled;
    case kBackingOff:
      return from == kLost;
    case kEnded:
      return true;
  }
  return false;
}

/// Checks each answer against the contract.
class Promises {
 public:
  void hold(const SupervisedNext& next) {
    if (const auto* changed = std::get_if<CameraStateChanged>(&next)) {
      EXPECT_TRUE(!state_ || mayFollow(*state_, changed->state))
          << toString(*state_) << " to " << toString(changed->state);
      EXPECT_FALSE(changed->reason.empty());
      EXPECT_EQ(changed->reason.find('\n'), std::string::npos);
      state_ = changed->state;
    } else if (const auto* format = std::get_if<FormatChanged>(&next)) {
      format_ = format->format.frame;
    } else if (const auto* frame = std::get_if<SupervisedFrame>(&next)) {
      EXPECT_EQ(state_, CameraState::kStreaming);
      EXPECT_EQ(frame->frame.image.format, format_) << "told before";
      frames_.push_back(*frame);
      frames_.back().frame.lease.reset();
    }
  }
  void holdSums(const FrameCounts& counts) {
    std::uint64_t expected = 0;
    TimePoint last = TimePoint::min();
    for (const SupervisedFrame& each : frames_) {
      expected += each.frame.droppedBefore + each.corruptBefore + each.incompleteBefore +
                  each.misTimedBefore;
      ASSERT_EQ(each.frame.sequence, expected++);
      ASSERT_GT(each.frame.captureTime, last);
      ASSERT_LE(each.lostInStall + each.frame.underrunsBefore, each.frame.droppedBefore);
      last = each.frame.captureTime;
    }
    EXPECT_EQ(counts.delivered, frames_.size());
    EXPECT_GE(counts.made(), expected) << "and what came after the last frame";
  }
  std::size_t frames() const { return frames_.size(); }

 private:
  std::optional<CameraState> state_;
  std::optional<FrameFormat> format_;
  std::vector<SupervisedFrame> frames_;
};

void liveThrough(unsigned seed) {
  RandomScript script(seed);
  Supervised supervised("auto");
  std::vector<std::shared_ptr<support::ScriptedDevice>> devices;
  for (const char* id : {"a", "b"}) {
    std::vector<ScriptedSession> sessions;
    for (int i = 0; i < 12; ++i) sessions.push_back(script.session());
    devices.push_back(supervised.add(std::move(sessions), id));
  }
  Promises promises;
  CameraSupervisor& supervisor = supervised.supervisor();
  for (int i = 0; i < 3000; ++i) {
    if (script.upTo(50) == 0) supervisor.devicesChanged();
    if (script.upTo(50) == 0) supervisor.wake();
    if (script.upTo(80) == 0) supervised.clock.advance(milliseconds(script.upTo(2000)));
    const TimePoint deadline = supervised.clock.now() + milliseconds(script.upTo(200));
    const Duration jumpedBefore = devices[0]->jumped + devices[1]->jumped;
    promises.hold(supervisor.next(deadline));
    const Duration jumped = devices[0]->jumped + devices[1]->jumped - jumpedBefore;
    ASSERT_LE(supervised.clock.now(), deadline + jumped);
    ASSERT_LE(devices[0]->alive + devices[1]->alive, 1);
  }
  promises.holdSums(supervisor.status().counts.frames);
  EXPECT_GT(promises.frames(), 0U);
  supervisor.stop();
  SupervisedNext last = supervisor.next(kNoDeadline);
  while (!std::holds_alternative<EndOfStream>(last)) {
    promises.hold(last);
    last = supervisor.next(kNoDeadline);
  }
  EXPECT_EQ(devices[0]->alive + devices[1]->alive, 0);
}

TEST(SupervisorProperty, KeepsItsPromisesInRandomLives) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    liveThrough(seed);
    if (testing::Test::HasFailure()) return;
  }
}

}  // namespace
}  // namespace pleinair::hal
