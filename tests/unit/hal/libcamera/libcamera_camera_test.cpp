#include <cerrno>
#include <chrono>
#include <vector>

#include <gmock/gmock.h>

#include "tests/unit/hal/libcamera/fake_sensor_test.h"

namespace pleinair::hal::libcamera {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

class LibcameraCameraTest : public FakeSensorTest {};

TEST_F(LibcameraCameraTest, TakesTheSizeThatLibcameraGives) {
  sensor.formats[0].sizes = {{320, 180}};
  sensor.adjusts[{320, 180}] = {318, 180};
  const auto format = start({.size = FrameSize{320, 180}});
  ASSERT_TRUE(format);
  EXPECT_EQ(format->frame.size, (FrameSize{318, 180}));
  EXPECT_EQ(frame().image.format.size, (FrameSize{318, 180}));
}

TEST_F(LibcameraCameraTest, DeliversRgbOfSwappedFormats) {
  sensor.formats = {{.fourcc = 0x34324752, .sizes = {{4, 2}}}};  // RGB888
  sensor.rowPadding = 2;
  ASSERT_TRUE(start({.size = FrameSize{4, 2}}));
  const CapturedFrame rgb = frame();
  EXPECT_EQ(rgb.image.format.pixelFormat, PixelFormat::kRgb8);
  EXPECT_THAT(rgb.image.map().view().row(0, 0),
              testing::ElementsAre(2, 1, 0, 5, 4, 3, 8, 7, 6, 11, 10, 9));
  EXPECT_THAT(rgb.image.map().view().row(0, 1).first(3), testing::ElementsAre(16, 15, 14));
  EXPECT_EQ(rgb.dmaBufs[0].fd, -1) << "a copy is in no dma-buf";
}

TEST_F(LibcameraCameraTest, CountsWhatTheDriverLost) {
  sensor.frames[2] = {.skipped = 4};
  ASSERT_TRUE(start());
  frame();
  EXPECT_EQ(frame().sequence, 1u);
  const CapturedFrame after = frame();
  EXPECT_EQ(after.droppedBefore, 4u);
  EXPECT_EQ(after.underrunsBefore, 0u);
  EXPECT_EQ(after.sequence, 6u);
}

TEST_F(LibcameraCameraTest, FaultyFramesAreCorrupt) {
  sensor.frames[0] = {.isFaulty = true};
  ASSERT_TRUE(start());
  EXPECT_EQ(frame().health, FrameHealth::kCorrupt);
  EXPECT_EQ(frame().health, FrameHealth::kValid);
  sensor.missingBytes = 1;
  ASSERT_TRUE(start());
  const CapturedFrame small = frame();
  EXPECT_EQ(small.health, FrameHealth::kCorrupt);
  EXPECT_TRUE(small.image.isComplete());
}

TEST_F(LibcameraCameraTest, FramesThatTheDriverHasNotFilledAreIncomplete) {
  for (const bool arePlanesSeparate : {false, true}) {
    sensor.arePlanesSeparate = arePlanesSeparate;
    sensor.frames[0] = {.missingBytes = 1};
    sensor.frames[2] = {.isFaulty = true, .missingBytes = 1};
    ASSERT_TRUE(start());
    const CapturedFrame small = frame();
    EXPECT_EQ(small.health, FrameHealth::kIncomplete) << arePlanesSeparate;
    EXPECT_TRUE(small.image.isComplete()) << "its memory is there";
    EXPECT_EQ(frame().health, FrameHealth::kValid) << arePlanesSeparate;
    EXPECT_EQ(frame().health, FrameHealth::kCorrupt) << "what the driver says of it comes first";
  }
}

TEST_F(LibcameraCameraTest, TrustsTimesOfTheSteadyClockOnly) {
  const auto at = [&](Duration time) {
    return support::FakeSensorFrame{.timestamp = time, .sensorTime = 7s};
  };
  sensor.frames[0] = at(clock_.now().time_since_epoch() + 30ms);
  sensor.frames[1] = at(Duration(1'700'000'000s));  // of the wall clock
  sensor.frames[2] = at(Duration(0));
  ASSERT_TRUE(start());
  const TimePoint begin = clock_.now();
  const CapturedFrame first = frame();
  EXPECT_EQ(first.captureTime, begin + 30ms);
  EXPECT_EQ(first.deviceTime, Duration(7s));
  EXPECT_EQ(first.timestampSource, TimestampSource::kEndOfReadout);
  const CapturedFrame second = frame();
  EXPECT_EQ(second.captureTime, begin + 80ms);
  EXPECT_EQ(second.timestampSource, TimestampSource::kArrival);
  EXPECT_EQ(frame().captureTime, begin + 120ms);
}

/// Frames arrive later than a period after their device time: a frame without one is younger than
/// the next frames' device times.
TEST_F(LibcameraCameraTest, TrustsTimesAgainAfterOneThatWasMissing) {
  constexpr Duration kPeriod = 40ms;
  constexpr Duration kOld = 60ms;
  const TimePoint begin = clock_.now();
  for (int i = 0; i < 5; ++i) {
    sensor.frames[static_cast<std::uint32_t>(i)] = {
        .timestamp = i == 1 ? Duration(0) : (begin + (i + 1) * kPeriod - kOld).time_since_epoch()};
  }
  ASSERT_TRUE(start());
  using enum TimestampSource;
  TimePoint last;
  for (const TimestampSource expected :
       {kEndOfReadout, kArrival, kArrival, kEndOfReadout, kEndOfReadout}) {
    const CapturedFrame now = frame();
    EXPECT_EQ(now.timestampSource, expected);
    EXPECT_GT(now.captureTime, last);
    last = now.captureTime;
  }
  EXPECT_EQ(last, begin + 5 * kPeriod - kOld);
}

TEST_F(LibcameraCameraTest, IsLostWhenLibcameraSaysSo) {
  sensor.frames[1] = {.isLost = true};
  ASSERT_TRUE(start());
  frame();
  for (int i = 0; i < 2; ++i) {
    const NextFrame answer = next();
    ASSERT_TRUE(std::holds_alternative<CameraLost>(answer));
    EXPECT_THAT(std::get<CameraLost>(answer).cause.message(),
                HasSubstr("is unplugged, or its driver is gone"));
  }
  camera_.reset();
  EXPECT_EQ(library_.told.open, 0);
}

TEST_F(LibcameraCameraTest, TimesOutWhenNothingIsSaid) {
  sensor.frames[1] = {.isSilent = true};
  ASSERT_TRUE(start());
  frame();
  EXPECT_TRUE(std::holds_alternative<CameraTimeout>(next())) << "the watchdog is to find out";
}

TEST_F(LibcameraCameraTest, TellsARefusedBufferFromALoss) {
  sensor.pushAnswer = -EACCES;
  ASSERT_TRUE(start());
  frame();  // is dropped, and goes back
  EXPECT_TRUE(std::holds_alternative<CameraLost>(next()));
  sensor.pushAnswer = -EIO;
  ASSERT_TRUE(start());
  frame();
  const NextFrame answer = next();
  ASSERT_TRUE(std::holds_alternative<Error>(answer));
  EXPECT_THAT(std::get<Error>(answer).message(), HasSubstr("refuses to requeue its buffers"));
}

TEST_F(LibcameraCameraTest, LendsBuffersAndCopiesTheLast) {
  options.buffers = 4;
  ASSERT_TRUE(start());
  std::vector<CapturedFrame> held;
  for (std::uint8_t i = 0; i < 20; ++i) {
    held.push_back(frame());
    ASSERT_EQ(held.back().droppedBefore, 0u) << "a consumer that holds frames stops no stream";
  }
  for (std::uint8_t i = 0; i < 20; ++i) {
    EXPECT_EQ(held[i].image.map().view().planes[0].bytes[0], i)
        << "what is held is not written over";
  }
}

TEST_F(LibcameraCameraTest, RefusesAnOrientationThatTheSensorCannotHave) {
  sensor.keepsOrientation = false;
  EXPECT_EQ(failure(), "started");
  options.orientation = Orientation::kRotated180;
  EXPECT_THAT(failure(), HasSubstr("set camera.libcamera.orientation to upright"));
  sensor.keepsOrientation = true;
  EXPECT_EQ(failure(), "started");
  EXPECT_EQ(library_.told.wish.orientation, Orientation::kRotated180);
}

}  // namespace
}  // namespace pleinair::hal::libcamera
