#include "hal/cameras/v4l2/chronology.h"

#include "tests/unit/hal/v4l2/fake_camera.h"

namespace pleinair::hal::v4l2 {
namespace {

constexpr std::uint32_t kMonotonic = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;

class V4l2Chronology : public testing::Test {
 protected:
  CapturedFrame stamped(const Filled& filled, bool wasStarving = false) {
    CapturedFrame frame;
    now_ += 40ms;
    chronology_.stamp(filled, wasStarving, now_, frame);
    return frame;
  }
  CapturedFrame numbered(std::uint32_t sequence, bool wasStarving = false) {
    return stamped({.flags = kMonotonic, .sequence = sequence}, wasStarving);
  }
  /// A frame stamped with a driver's time, relative to now.
  CapturedFrame dated(std::uint32_t flags, Duration time) {
    return stamped({.flags = flags, .sequence = nextNumber_++, .timestamp = time});
  }

  Chronology chronology_;
  TimePoint now_{10s};
  std::uint32_t nextNumber_ = 0;
};

TEST_F(V4l2Chronology, CountsFromZeroWhateverTheDriverSays) {
  EXPECT_EQ(numbered(123'456).sequence, 0u);
  EXPECT_EQ(numbered(123'457).sequence, 1u);
}

TEST_F(V4l2Chronology, CountsGapsAsDropped) {
  numbered(4);
  const CapturedFrame frame = numbered(8);
  EXPECT_EQ(frame.sequence, 4u);
  EXPECT_EQ(frame.droppedBefore, 3u);
  EXPECT_EQ(frame.underrunsBefore, 0u);
  EXPECT_EQ(numbered(11, true).underrunsBefore, 2u);
}

TEST_F(V4l2Chronology, CountsOverTheWrap) {
  numbered(0xFFFFFFFE);
  EXPECT_EQ(numbered(0xFFFFFFFF).sequence, 1u);
  const CapturedFrame frame = numbered(1);
  EXPECT_EQ(frame.sequence, 3u);
  EXPECT_EQ(frame.droppedBefore, 1u);
}

TEST_F(V4l2Chronology, TakesANumberThatDoesNotRiseForTheNext) {
  numbered(7);
  EXPECT_EQ(numbered(7).sequence, 1u);
  EXPECT_EQ(numbered(2).sequence, 2u);
  EXPECT_EQ(numbered(3).sequence, 3u);
}

TEST_F(V4l2Chronology, GoesOnAfterTheDeviceWasRestarted) {
  numbered(0);
  numbered(1);
  chronology_.deviceRestarted();
  EXPECT_EQ(numbered(5).sequence, 2u);
}

TEST_F(V4l2Chronology, SaysWhatTheTimeIsOf) {
  EXPECT_EQ(dated(kMonotonic | V4L2_BUF_FLAG_TSTAMP_SRC_SOE, 10s).timestampSource,
            TimestampSource::kStartOfExposure);
  const CapturedFrame end = dated(kMonotonic | V4L2_BUF_FLAG_TSTAMP_SRC_EOF, 10s + 1ms);
  EXPECT_EQ(end.timestampSource, TimestampSource::kEndOfReadout);
  EXPECT_EQ(end.captureTime, TimePoint(10s + 1ms));
  EXPECT_EQ(end.deviceTime, Duration(10s + 1ms));
}

TEST_F(V4l2Chronology, TrustsNoOtherClock) {
  for (const std::uint32_t flags : {std::uint32_t{V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN},
                                    std::uint32_t{V4L2_BUF_FLAG_TIMESTAMP_COPY}}) {
    const CapturedFrame frame = dated(flags | V4L2_BUF_FLAG_TSTAMP_SRC_SOE, 10s);
    EXPECT_EQ(frame.timestampSource, TimestampSource::kArrival);
    EXPECT_EQ(frame.captureTime, now_);
  }
}

TEST_F(V4l2Chronology, TakesATimeThatIsALittleAheadForNow) {
  const CapturedFrame frame = dated(kMonotonic, now_.time_since_epoch() + 40ms + 36ms);
  EXPECT_EQ(frame.timestampSource, TimestampSource::kEndOfReadout);
  EXPECT_EQ(frame.captureTime, now_);
  EXPECT_EQ(frame.deviceTime, now_.time_since_epoch() + 36ms);
}

TEST_F(V4l2Chronology, TrustsNoTimeThatIsMissingOrFarAhead) {
  const CapturedFrame unset = dated(kMonotonic, 0s);
  EXPECT_EQ(unset.timestampSource, TimestampSource::kArrival);
  EXPECT_EQ(unset.deviceTime, std::nullopt);
  EXPECT_EQ(dated(kMonotonic, 10'000s).timestampSource, TimestampSource::kArrival);
}

TEST_F(V4l2Chronology, RisesStrictlyThoughTheClockStands) {
  CapturedFrame first;
  CapturedFrame second;
  chronology_.stamp({.sequence = 0}, false, now_, first);
  chronology_.stamp({.sequence = 1}, false, now_, second);
  EXPECT_GT(second.captureTime, first.captureTime);
}

}  // namespace
}  // namespace pleinair::hal::v4l2
