#include "hal/cameras/aravis/frame_numbers.h"

#include <chrono>

#include <gtest/gtest.h>

namespace pleinair::hal::aravis {
namespace {

using namespace std::chrono_literals;

class FrameNumbersTest : public testing::Test {
 protected:
  CapturedFrame stamp(std::uint64_t id, StreamCounts counts = {},
                      std::optional<Duration> age = std::nullopt) {
    CapturedFrame frame;
    now_ += 40ms;
    numbers_.stamp({.frameId = id, .age = age}, counts, now_, frame);
    return frame;
  }

  TimePoint now_{100s};
  FrameNumbers numbers_{Transport::kGige};
};

TEST_F(FrameNumbersTest, CountFromTheFirst) {
  EXPECT_EQ(stamp(77).sequence, 0u);
  EXPECT_EQ(stamp(78).sequence, 1u);
  const CapturedFrame later = stamp(82);
  EXPECT_EQ(later.sequence, 5u);
  EXPECT_EQ(later.droppedBefore, 3u);
  EXPECT_EQ(later.underrunsBefore, 0u);
}

TEST_F(FrameNumbersTest, WrapPastZero) {
  stamp(65534);
  EXPECT_EQ(stamp(65535).droppedBefore, 0u);
  EXPECT_EQ(stamp(1).droppedBefore, 0u);
  stamp(65534);  // a step of nearly the whole range is one back
  const CapturedFrame next = stamp(3);
  EXPECT_EQ(next.droppedBefore, 3u) << "65535, 1 and 2";
}

TEST_F(FrameNumbersTest, TakeWhatDoesNotRiseForTheNext) {
  stamp(500);
  EXPECT_EQ(stamp(500).sequence, 1u);
  EXPECT_EQ(stamp(400).sequence, 2u);
  EXPECT_EQ(stamp(0).sequence, 3u);
}

TEST_F(FrameNumbersTest, Of64BitsDoNotWrap) {
  FrameNumbers usb(Transport::kUsb3);
  CapturedFrame frame;
  usb.stamp({.frameId = 65535}, {}, now_, frame);
  usb.stamp({.frameId = 65536}, {}, now_ + 1ms, frame);
  EXPECT_EQ(frame.sequence, 1u);
  usb.stamp({.frameId = 3}, {}, now_ + 2ms, frame);
  EXPECT_EQ(frame.sequence, 2u);
  EXPECT_EQ(frame.droppedBefore, 0u);
}

TEST_F(FrameNumbersTest, TellUnderrunsFromOtherLosses) {
  stamp(1);
  EXPECT_EQ(stamp(2, {.underruns = 2}).underrunsBefore, 0u) << "the gap is not seen yet";
  const CapturedFrame after = stamp(6, {.underruns = 2});
  EXPECT_EQ(after.droppedBefore, 3u);
  EXPECT_EQ(after.underrunsBefore, 2u);
  EXPECT_EQ(stamp(8, {.underruns = 2}).underrunsBefore, 0u);
}

TEST_F(FrameNumbersTest, TellWhatHappenedToPacketsSinceTheLastFrame) {
  const StreamCounts first{.missingPackets = 3, .resentPackets = 5, .ignoredPackets = 1};
  EXPECT_EQ(stamp(1, first).linkBefore,
            (LinkCounts{.missingPackets = 3, .resentPackets = 5, .ignoredPackets = 1}));
  EXPECT_EQ(stamp(2, first).linkBefore, LinkCounts{});
  StreamCounts more = first;
  more.resentPackets += 4;
  EXPECT_EQ(stamp(3, more).linkBefore, LinkCounts{.resentPackets = 4});
}

TEST_F(FrameNumbersTest, TimeFramesByTheirFirstPacket) {
  const auto captureAge = [&](Duration age) {
    const TimePoint captured = stamp(1, {}, age).captureTime;
    return now_ - captured;
  };
  EXPECT_EQ(captureAge(15ms), Duration(15ms));
  EXPECT_EQ(captureAge(-1ms), Duration(0)) << "the wall clock went back";
  EXPECT_EQ(captureAge(3600s), Duration(0)) << "the wall clock was set";
  const TimePoint last = now_;
  EXPECT_EQ(stamp(4, {}, 41ms).captureTime, last + 1ns) << "times rise";
}

TEST_F(FrameNumbersTest, PreferTheTimeOfTheChunkData) {
  CapturedFrame frame;
  numbers_.stamp({.frameId = 1, .deviceTime = 3s, .chunkTime = 5s}, {}, now_, frame);
  EXPECT_EQ(frame.deviceTime, Duration(5s));
  numbers_.stamp({.frameId = 2, .deviceTime = 4s}, {}, now_, frame);
  EXPECT_EQ(frame.deviceTime, Duration(4s));
  CapturedFrame without;
  numbers_.stamp({.frameId = 3}, {}, now_, without);
  EXPECT_FALSE(without.deviceTime);
}

}  // namespace
}  // namespace pleinair::hal::aravis
