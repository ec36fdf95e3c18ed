#include "pipeline/runtime/control/latency_control.h"

#include <gtest/gtest.h>

namespace pleinair::runtime {
namespace {

using namespace std::chrono_literals;

class LatencyControlTest : public testing::Test {
 protected:
  static constexpr hal::Duration kPeriod = 33ms;
  /// Notes frames, each ready `ready` after its capture.
  void run(hal::Duration duration, hal::Duration ready, bool isLowest) {
    for (const hal::TimePoint end = now_ + duration; now_ < end; now_ += kPeriod) {
      control_.ready(control_.latency() - ready, isLowest, now_);
    }
  }

  hal::TimePoint now_{1h};
  LatencyControl control_{{.configured = 120ms, .maximum = 200ms, .step = 16ms}};
};

TEST_F(LatencyControlTest, StaysWhereItWasConfigured) {
  run(60s, 100ms, true);
  EXPECT_EQ(control_.latency(), 120ms);
  EXPECT_EQ(control_.raised() + control_.lowered(), 0u);
}

TEST_F(LatencyControlTest, LeavesItToQualityWhileThatCanFall) {
  run(10s, 170ms, false);
  EXPECT_EQ(control_.latency(), 120ms);
}

TEST_F(LatencyControlTest, RisesByAsManyRefreshesAsWereMissingAfterASecond) {
  run(900ms, 140ms, true);
  EXPECT_EQ(control_.latency(), 120ms);
  run(200ms, 140ms, true);
  EXPECT_EQ(control_.latency(), 152ms) << "20 ms late: two refreshes";
  EXPECT_EQ(control_.raised(), 1u);
  run(4s, 140ms, true);
  EXPECT_EQ(control_.latency(), 152ms);
}

TEST_F(LatencyControlTest, NeverPassesItsMaximum) {
  run(30s, 900ms, true);
  EXPECT_EQ(control_.latency(), 200ms);
  EXPECT_EQ(control_.raised(), 1u);
}

TEST_F(LatencyControlTest, GoesBackByOneRefreshAtATime) {
  run(3s, 190ms, true);
  const hal::Duration high = control_.latency();
  ASSERT_GT(high, 180ms);
  run(5200ms, 60ms, true);
  EXPECT_EQ(control_.latency(), high - 16ms);
  run(60s, 60ms, false);
  EXPECT_EQ(control_.latency(), 120ms);
  EXPECT_EQ(control_.lowered(), 5u);
}

TEST_F(LatencyControlTest, DoesNotSwingBetweenTwoValues) {
  run(10min, 130ms, true);
  EXPECT_EQ(control_.latency(), 136ms);
  EXPECT_EQ(control_.raised(), 1u);
  EXPECT_EQ(control_.lowered(), 0u);
}

TEST_F(LatencyControlTest, ForgivesSingleLatePictures) {
  for (int i = 0; i < 300; ++i) {
    now_ += kPeriod;
    control_.ready(i % 3 == 0 ? -50ms : 20ms, true, now_);
  }
  EXPECT_EQ(control_.latency(), 120ms);
}

TEST_F(LatencyControlTest, ForgivesTheFirstPictureAfterAPause) {
  run(1050ms, 100ms, true);  // a second has just been judged
  now_ += 30s;
  control_.ready(-150ms, true, now_);
  run(10s, 100ms, true);
  EXPECT_EQ(control_.raised(), 0u);
}

}  // namespace
}  // namespace pleinair::runtime
