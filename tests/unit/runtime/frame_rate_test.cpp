#include "pipeline/runtime/frame_rate.h"

#include <gtest/gtest.h>

namespace pleinair::runtime {
namespace {

using namespace std::chrono_literals;

TEST(FrameRate, IsSteadyForASteadyRate) {
  FrameRate rate;
  hal::TimePoint now{1h};
  for (int i = 0; i < 300; ++i) {
    now += 40ms;
    rate.count(now);
    if (i > 0) {
      EXPECT_NEAR(rate.perSecond(now + 39ms), 25.0, 0.01) << i;
    }
  }
}

TEST(FrameRate, FallsWhereNothingComesAnyMore) {
  FrameRate rate;
  hal::TimePoint now{1h};
  EXPECT_EQ(rate.perSecond(now), 0.0);
  for (int i = 0; i < 30; ++i) rate.count(now += 40ms);
  EXPECT_LT(rate.perSecond(now + 500ms), 2.1);
  EXPECT_EQ(rate.perSecond(now + 3s), 0.0);
}

TEST(FrameRate, KeepsUpWithHighRates) {
  FrameRate rate;
  hal::TimePoint now{1h};
  for (int i = 0; i < 2'000; ++i) rate.count(now += 1ms);
  EXPECT_NEAR(rate.perSecond(now), 1000.0, 1.0);
}

}  // namespace
}  // namespace pleinair::runtime
