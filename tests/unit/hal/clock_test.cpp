#include "hal/clock.h"

#include <gtest/gtest.h>

namespace pleinair::hal {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""h;

TEST(SteppedClock, JumpsToTheWakeUpTimeAndNeverBack) {
  SteppedClock clock;
  EXPECT_TRUE(clock.sleepUntil(TimePoint(40ms)));
  EXPECT_EQ(clock.now(), TimePoint(40ms));
  EXPECT_TRUE(clock.sleepUntil(TimePoint(10ms)));
  EXPECT_EQ(clock.now(), TimePoint(40ms));
  clock.advance(2ms);
  EXPECT_EQ(clock.now(), TimePoint(42ms));
}

TEST(SteppedClock, DoesNotMoveForAStoppedSleeper) {
  SteppedClock clock;
  std::stop_source stop;
  stop.request_stop();
  EXPECT_FALSE(clock.sleepUntil(TimePoint(40ms), stop.get_token()));
  EXPECT_EQ(clock.now(), TimePoint{});
}

TEST(SteadyClock, SleepsNotAtAllForAPastTimeAndWakesForAStop) {
  SteadyClock clock;
  EXPECT_TRUE(clock.sleepUntil(clock.now() - 1ms));
  std::stop_source stop;
  stop.request_stop();
  const TimePoint before = clock.now();
  EXPECT_FALSE(clock.sleepUntil(before + 1h, stop.get_token()));
  EXPECT_LT(clock.now(), before + 1h);
}

TEST(Durations, AreNumbersAndBack) {
  EXPECT_EQ(toSeconds(1500ms), 1.5);
  EXPECT_EQ(toMilliseconds(Duration(33'333'333)), 33.333333);
  EXPECT_EQ(fromSeconds(-1.5), -1500ms);
  EXPECT_EQ(fromMilliseconds(0.0000016), Duration(2)) << "rounded, not cut";
}

}  // namespace
}  // namespace pleinair::hal
