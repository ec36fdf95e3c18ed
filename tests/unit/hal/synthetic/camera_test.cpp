#include <algorithm>
#include <chrono>
#include <limits>

#include "tests/unit/hal/synthetic/captured.h"

namespace pleinair::hal::synthetic {
namespace {

using std::chrono::milliseconds;

bool sameBytes(const Image& a, const Image& b) {
  return std::ranges::equal(bytesOf(a), bytesOf(b));
}

TEST(SyntheticCamera, MakesTheSameFramesForTheSameOptions) {
  const std::vector<Image> first = capturedFrames(smallOptions(), 3);
  const std::vector<Image> second = capturedFrames(smallOptions(), 3);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(sameBytes(first[i], second[i])) << i;
  EXPECT_FALSE(sameBytes(first[0], first[1]));
}

TEST(SyntheticCamera, AFrameDoesNotDependOnThoseBefore) {
  SyntheticOptions options = smallOptions();
  const std::vector<Image> all = capturedFrames(options, 6);
  options.pacing = Pacing::kRealTime;
  SteppedClock clock;
  SyntheticCamera camera(options, clock);
  ASSERT_TRUE(camera.start({}));
  clock.advance(5 * options.framePeriod);  // the first five are too late
  const NextFrame next = camera.next(kNoDeadline);
  const auto& frame = std::get<CapturedFrame>(next);
  EXPECT_EQ(frame.sequence, 5u);
  EXPECT_EQ(frame.droppedBefore, 5u);
  EXPECT_TRUE(sameBytes(Image(frame.image), all[5]));
}

TEST(SyntheticCamera, SeedsGiveOtherPicturesAndPaths) {
  SyntheticOptions options = smallOptions();
  const std::vector<Image> first = capturedFrames(options, 1);
  options.seed = 2;
  EXPECT_FALSE(sameBytes(first[0], capturedFrames(options, 1)[0]));
  SteppedClock clock;
  const SyntheticCamera one(smallOptions(), clock);
  const SyntheticCamera two(options, clock);
  EXPECT_NE(one.truth(0).cameraFromWorld, two.truth(0).cameraFromWorld);
}

TEST(SyntheticCamera, SaysWhenEachFrameWasTaken) {
  SteppedClock clock(TimePoint(milliseconds(500)));
  SyntheticOptions options = smallOptions();
  options.framePeriod = Duration(33'333'333);
  SyntheticCamera camera(options, clock);
  ASSERT_TRUE(camera.start({}));
  for (int i = 0; i < 3; ++i) {
    const NextFrame next = camera.next(kNoDeadline);
    const auto& frame = std::get<CapturedFrame>(next);
    EXPECT_EQ(frame.captureTime, TimePoint(milliseconds(500)) + i * Duration(33'333'333));
    EXPECT_EQ(frame.timestampSource, TimestampSource::kSimulated);
  }
  EXPECT_EQ(clock.now(), TimePoint(milliseconds(500))) << "stepped frames wait for nothing";
}

TEST(SyntheticCamera, InRealTimeWaitsForEachFrame) {
  SteppedClock clock;
  SyntheticOptions options = smallOptions();
  options.pacing = Pacing::kRealTime;
  SyntheticCamera camera(options, clock);
  ASSERT_TRUE(camera.start({}));
  for (int i = 0; i < 3; ++i) {
    const NextFrame next = camera.next(kNoDeadline);
    EXPECT_EQ(std::get<CapturedFrame>(next).droppedBefore, 0u);
    EXPECT_EQ(clock.now(), TimePoint(i * options.framePeriod));
  }
}

TEST(SyntheticCamera, EndsAtItsLastFrameEvenWhenLate) {
  SteppedClock clock;
  SyntheticOptions options = smallOptions();
  options.pacing = Pacing::kRealTime;
  options.frameCount = 4;
  SyntheticCamera camera(options, clock);
  ASSERT_TRUE(camera.start({}));
  clock.advance(std::chrono::hours(1));
  const NextFrame last = camera.next(kNoDeadline);
  EXPECT_EQ(std::get<CapturedFrame>(last).sequence, 3u);
  EXPECT_TRUE(std::holds_alternative<EndOfStream>(camera.next(kNoDeadline)));
}

TEST(SyntheticCamera, GivesItsBuffersOutAgain) {
  SteppedClock clock;
  SyntheticCamera camera(smallOptions(), clock);
  ASSERT_TRUE(camera.start({}));
  NextFrame held = camera.next(kNoDeadline);
  const std::uint8_t* heldPixels = std::get<CapturedFrame>(held).image.planes[0].bytes.data();
  const NextFrame other = camera.next(kNoDeadline);
  EXPECT_NE(std::get<CapturedFrame>(other).image.planes[0].bytes.data(), heldPixels);
  held = CameraTimeout{};
  const NextFrame reused = camera.next(kNoDeadline);
  EXPECT_EQ(std::get<CapturedFrame>(reused).image.planes[0].bytes.data(), heldPixels);
}

TEST(SyntheticCamera, RefusesOptionsThatMakeNoSense) {
  SteppedClock clock;
  const auto kindFor = [&clock](const SyntheticOptions& options) {
    const Result<StreamFormat> format = SyntheticCamera(options, clock).start({});
    return format ? ErrorKind::kInternal : format.error().kind;
  };
  EXPECT_EQ(kindFor({.size = {0, 480}}), ErrorKind::kUnsupported);
  EXPECT_EQ(kindFor({.size = {kMaxSidePixels + 1, 480}}), ErrorKind::kUnsupported);
  EXPECT_EQ(kindFor({.framePeriod = Duration::zero()}), ErrorKind::kInvalidArgument);
  EXPECT_EQ(kindFor({.noiseSigma = -1}), ErrorKind::kInvalidArgument);
  EXPECT_EQ(kindFor({.noiseSigma = std::numeric_limits<double>::quiet_NaN()}),
            ErrorKind::kInvalidArgument);
}

}  // namespace
}  // namespace pleinair::hal::synthetic
