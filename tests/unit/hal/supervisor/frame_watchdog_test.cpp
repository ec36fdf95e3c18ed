#include "hal/supervisor/frame_watchdog.h"

#include <gtest/gtest.h>

namespace pleinair::hal {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;

constexpr Duration kPollInterval = milliseconds(50);

TEST(FrameWatchdog, LimitIsThreePeriodsAndAMargin) {
  FrameWatchdog watchdog({}, kPollInterval);
  watchdog.expect(milliseconds(40));
  EXPECT_EQ(watchdog.limit(), milliseconds(320));
  watchdog.expect(std::nullopt);
  EXPECT_EQ(watchdog.limit(), milliseconds(500));
}

TEST(FrameWatchdog, AddsUpSilenceAndForgetsItWithAFrame) {
  FrameWatchdog watchdog({}, kPollInterval);
  watchdog.expect(milliseconds(40));
  TimePoint now{};
  watchdog.frameCame(now);
  for (int i = 0; i < 8; ++i) watchdog.nothingCame(now += milliseconds(40));
  EXPECT_EQ(watchdog.silence(), milliseconds(320));
  EXPECT_FALSE(watchdog.isBeyondLimit());
  watchdog.nothingCame(now += milliseconds(1));
  EXPECT_TRUE(watchdog.isBeyondLimit());
  watchdog.frameCame(now);
  EXPECT_EQ(watchdog.silence(), Duration::zero());
}

TEST(FrameWatchdog, ALongAbsenceCountsAsOneLook) {
  FrameWatchdog watchdog({}, kPollInterval);
  watchdog.expect(milliseconds(40));
  watchdog.frameCame(TimePoint{});
  watchdog.nothingCame(TimePoint{} + hours(1));
  EXPECT_EQ(watchdog.silence(), kPollInterval);
  watchdog.nothingCame(TimePoint{});  // a clock that jumps back changes nothing
  EXPECT_EQ(watchdog.silence(), kPollInterval);
}

}  // namespace
}  // namespace pleinair::hal
