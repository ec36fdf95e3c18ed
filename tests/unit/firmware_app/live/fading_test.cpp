#include "firmware_app/live/fading.h"

#include <gtest/gtest.h>

#include "firmware_app/live/frame_rate.h"

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;
constexpr hal::TimePoint kStart{100s};

TEST(Fading, IsNothingUntilItIsCalledUp) {
  EXPECT_EQ(Fading().opacity(kStart), 0.0);
}

TEST(Fading, StaysForThreeSecondsAndGoes) {
  Fading fading;
  fading.callUp(kStart);
  EXPECT_EQ(fading.opacity(kStart), 1.0);
  EXPECT_EQ(fading.opacity(kStart + 3s), 1.0);
  EXPECT_NEAR(fading.opacity(kStart + 3250ms), 0.5, 1e-9);
  EXPECT_EQ(fading.opacity(kStart + 3500ms), 0.0);
  EXPECT_EQ(fading.opacity(kStart + 1h), 0.0);
  fading.callUp(kStart + 1h);
  EXPECT_EQ(fading.opacity(kStart + 1h + 1s), 1.0);
}

TEST(FrameRate, LooksBackASecond) {
  FrameRate rate;
  EXPECT_EQ(rate.perSecond(), 0.0);
  hal::TimePoint now = kStart;
  rate.count(now);
  EXPECT_EQ(rate.perSecond(), 0.0);
  for (int i = 0; i < 20; ++i) rate.count(now += 100ms);
  EXPECT_NEAR(rate.perSecond(), 10.0, 1e-9);
  for (int i = 0; i < 50; ++i) rate.count(now += 20ms);
  EXPECT_NEAR(rate.perSecond(), 50.0, 1e-9) << "the slow ones are forgotten";
  rate.count(now += 1min);
  EXPECT_EQ(rate.perSecond(), 0.0);
}

}  // namespace
}  // namespace pleinair::app
