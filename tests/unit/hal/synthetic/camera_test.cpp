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
  keepWorkbenchOf(options);
  clock.advance(5 * options.framePeriod);  // the first five are missed
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
  keepWorkbenchOf(options);
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
  keepWorkbenchOf(options);
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
  keepWorkbenchOf(options);
  clock.advance(std::chrono::hours(1));
  const NextFrame last = camera.next(kNoDeadline);
  EXPECT_EQ(std::get<CapturedFrame>(last).sequence, 3u);
  EXPECT_TRUE(std::holds_alternative<EndOfStream>(camera.next(kNoDeadline)));
}

TEST(SyntheticCamera, GivesItsBuffersOutAgain) {
  SteppedClock clock;
  SyntheticCamera camera(smallOptions(), clock);
  ASSERT_TRUE(camera.start({}));
  keepWorkbenchOf(smallOptions());
  NextFrame held = camera.next(kNoDeadline);
  const std::uint8_t* heldPixels =
      std::get<CapturedFrame>(held).image.map().view().planes[0].bytes.data();
  const NextFrame other = camera.next(kNoDeadline);
  EXPECT_NE(std::get<CapturedFrame>(other).image.map().view().planes[0].bytes.data(), heldPixels);
  held = CameraTimeout{};
  const NextFrame reused = camera.next(kNoDeadline);
  EXPECT_EQ(std::get<CapturedFrame>(reused).image.map().view().planes[0].bytes.data(), heldPixels);
}

TEST(SyntheticCamera, StaysExactlyStillInTheStillShot) {
  SyntheticOptions options = noiseFreeOptions(SyntheticShot::kStill);
  const std::vector<Image> still = capturedFrames(options, 3);
  EXPECT_TRUE(sameBytes(still[0], still[1]));
  EXPECT_TRUE(sameBytes(still[0], still[2]));
  options.rowTime = milliseconds(1);
  EXPECT_TRUE(sameBytes(still[0], capturedFrames(options, 1)[0])) << "whatever the shutter";
  options.noiseSigma = 2;
  const std::vector<Image> noisy = capturedFrames(options, 2);
  EXPECT_FALSE(sameBytes(noisy[0], noisy[1]));
}

double meanLevel(const Image& image, std::size_t channel) {
  double sum = 0;
  const auto bytes = bytesOf(image);
  for (std::size_t i = channel; i < bytes.size(); i += 3) sum += bytes[i];
  return 3 * sum / static_cast<double>(bytes.size());
}

TEST(SyntheticCamera, DriftsAsFarAsAskedFor) {
  SyntheticOptions options = smallOptions();
  options.shot = SyntheticShot::kStill;
  options.framePeriod = milliseconds(400);
  options.exposureDriftStops = 0.5;
  const std::vector<Image> exposed = capturedFrames(options, 16);
  options.exposureDriftStops = 0;
  options.whiteBalanceDrift = 0.2;
  const std::vector<Image> balanced = capturedFrames(options, 16);
  options.whiteBalanceDrift = 0;
  const Image plain = capturedFrames(options, 1)[0];
  double darkest = 1;
  double brightest = 1;
  double coolest = 1;
  double warmest = 1;
  for (std::size_t i = 0; i < exposed.size(); ++i) {
    const double brightness = meanLevel(exposed[i], 1) / meanLevel(plain, 1);
    darkest = std::min(darkest, brightness);
    brightest = std::max(brightest, brightness);
    const double warmth = meanLevel(balanced[i], 0) / meanLevel(balanced[i], 2) /
                          (meanLevel(plain, 0) / meanLevel(plain, 2));
    coolest = std::min(coolest, warmth);
    warmest = std::max(warmest, warmth);
    EXPECT_NEAR(meanLevel(balanced[i], 1), meanLevel(plain, 1), 0.2) << "green stays";
  }
  // Half a stop is a factor of 1.41 in light, about 1.18 in coded levels.
  EXPECT_LT(darkest, 0.95);
  EXPECT_GT(darkest, 0.80);
  EXPECT_GT(brightest, 1.05);
  EXPECT_LT(brightest, 1.22);
  EXPECT_LT(coolest, 0.96);
  EXPECT_GT(coolest, 0.80);
  EXPECT_GT(warmest, 1.04);
  EXPECT_LT(warmest, 1.24);
}

TEST(SyntheticCamera, KnowsThePoseOfEachRow) {
  SteppedClock clock;
  SyntheticOptions options{.shot = SyntheticShot::kPan};
  const SyntheticCamera global(options, clock);
  EXPECT_EQ(global.cameraFromWorld(3, 0), global.cameraFromWorld(3, 479));
  EXPECT_EQ(global.cameraFromWorld(3, 0), global.truth(3).cameraFromWorld);
  options.rowTime = options.framePeriod / 480;
  const SyntheticCamera rolling(options, clock);
  EXPECT_EQ(rolling.cameraFromWorld(3, 0), global.cameraFromWorld(3, 0));
  EXPECT_NE(rolling.cameraFromWorld(3, 0), rolling.cameraFromWorld(3, 479));
  EXPECT_EQ(rolling.cameraFromWorld(3, 240), rolling.truth(3).cameraFromWorld);
}

TEST(SyntheticCamera, NamesItsShot) {
  SteppedClock clock;
  const SyntheticCamera camera({.shot = SyntheticShot::kDolly}, clock);
  EXPECT_NE(camera.identity().description.find("dolly"), std::string::npos);
  EXPECT_NE(camera.identity().id, SyntheticCamera({}, clock).identity().id);
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
  EXPECT_EQ(kindFor({.noiseSigma = 41}), ErrorKind::kInvalidArgument);
  EXPECT_EQ(kindFor({.noiseSigma = std::numeric_limits<double>::quiet_NaN()}),
            ErrorKind::kInvalidArgument);
  EXPECT_EQ(kindFor({.exposureDriftStops = -0.1}), ErrorKind::kInvalidArgument);
  EXPECT_EQ(kindFor({.exposureDriftStops = 2.1}), ErrorKind::kInvalidArgument);
  EXPECT_EQ(kindFor({.whiteBalanceDrift = 0.6}), ErrorKind::kInvalidArgument);
  EXPECT_EQ(kindFor({.rowTime = Duration(-1)}), ErrorKind::kInvalidArgument);
  EXPECT_EQ(kindFor({.rowTime = Duration(33'333'333) / 400}), ErrorKind::kInvalidArgument)
      << "480 rows would take longer than a frame";
}

}  // namespace
}  // namespace pleinair::hal::synthetic
