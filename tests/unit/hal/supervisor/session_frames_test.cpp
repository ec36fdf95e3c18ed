#include "hal/supervisor/session_frames.h"

#include <memory>

#include <gtest/gtest.h>

#include "hal/image.h"

namespace pleinair::hal {
namespace {

using std::chrono::milliseconds;

CapturedFrame frameAt(TimePoint time, std::uint64_t dropped = 0, std::uint64_t underruns = 0) {
  const auto image =
      std::make_shared<Image>(FrameFormat{.pixelFormat = PixelFormat::kGrey8, .size = {4, 4}});
  return {.image = image->view(),
          .dmaBufs = {},
          .sequence = 77,
          .droppedBefore = dropped,
          .underrunsBefore = underruns,
          .captureTime = time,
          .lease = image};
}

constexpr TimePoint kStart{milliseconds(1000)};

TEST(SessionFrames, NumbersOnAcrossSessions) {
  SessionFrames frames;
  frames.beginSession(true);
  auto first = frames.take(frameAt(kStart, 3), kStart, false);
  EXPECT_EQ(std::get<SupervisedFrame>(first).frame.sequence, 3U);
  frames.beginSession(true);
  auto second = frames.take(frameAt(kStart + milliseconds(1)), kStart + milliseconds(1), false);
  EXPECT_EQ(std::get<SupervisedFrame>(second).frame.sequence, 4U);
}

TEST(SessionFrames, CarriesWhatWasLostBeforeARefusedFrameOverALoss) {
  SessionFrames frames;
  frames.beginSession(true);
  frames.take(frameAt(kStart), kStart, false);
  EXPECT_EQ(std::get<FrameRefusal>(frames.take(frameAt(kStart, 5, 1), kStart, true)),
            FrameRefusal::kMisTimed);
  EXPECT_EQ(frames.counts().lostInStall, 4U) << "told before the next frame";
  frames.beginSession(true);
  const auto taken =
      frames.take(frameAt(kStart + milliseconds(1), 1), kStart + milliseconds(1), false);
  const auto& frame = std::get<SupervisedFrame>(taken);
  EXPECT_EQ(frame.frame.droppedBefore, 6U);
  EXPECT_EQ(frame.frame.underrunsBefore, 1U);
  EXPECT_EQ(frame.lostInStall, 4U);
  EXPECT_EQ(frame.misTimedBefore, 1U);
  EXPECT_EQ(frame.frame.sequence, 8U);
  EXPECT_EQ(frames.counts().made(), 9U);
}

TEST(SessionFrames, OfRecordingsTimesMayRunAheadOfTheClock) {
  SessionFrames frames;
  const TimePoint later = kStart + SessionFrames::kFutureTolerance + Duration(1);
  frames.beginSession(true);
  EXPECT_TRUE(std::holds_alternative<FrameRefusal>(frames.take(frameAt(later), kStart, false)));
  frames.beginSession(false);
  EXPECT_TRUE(std::holds_alternative<SupervisedFrame>(frames.take(frameAt(later), kStart, false)));
}

TEST(SessionFrames, CountsPacketsAndNotAsFrames) {
  SessionFrames frames;
  CapturedFrame broken = frameAt(kStart);
  broken.health = FrameHealth::kIncomplete;
  broken.linkBefore = {.missingPackets = 3, .resentPackets = 5};
  frames.take(std::move(broken), kStart, false);
  EXPECT_EQ(frames.counts().link, (LinkCounts{.missingPackets = 3, .resentPackets = 5}));
  CapturedFrame whole = frameAt(kStart + milliseconds(1));
  whole.linkBefore = {.resentPackets = 2, .ignoredPackets = 1};
  frames.take(std::move(whole), kStart + milliseconds(1), false);
  EXPECT_EQ(frames.counts().link,
            (LinkCounts{.missingPackets = 3, .resentPackets = 7, .ignoredPackets = 1}));
  EXPECT_EQ(frames.counts().made(), 2U);
}

TEST(SessionFrames, MoreStarvedThanDroppedIsFixed) {
  SessionFrames frames;
  const auto taken = frames.take(frameAt(kStart, 2, 9), kStart, false);
  EXPECT_EQ(std::get<SupervisedFrame>(taken).frame.underrunsBefore, 2U);
}

}  // namespace
}  // namespace pleinair::hal
