#include <gtest/gtest.h>

#include "firmware_app/live/interaction/live_caption.h"

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;
constexpr hal::TimePoint kStart{100s};

TEST(Fading, IsNothingUntilItIsCalledUp) {
  EXPECT_EQ(Fading().opacity(kStart), 0.0);
}

TEST(Fading, StaysForThreeSecondsAndGoes) {
  Fading fading;
  fading.restart(kStart);
  EXPECT_EQ(fading.opacity(kStart), 1.0);
  EXPECT_EQ(fading.opacity(kStart + 3s), 1.0);
  EXPECT_NEAR(fading.opacity(kStart + 3250ms), 0.5, 1e-9);
  EXPECT_EQ(fading.opacity(kStart + 3500ms), 0.0);
  EXPECT_EQ(fading.opacity(kStart + 1h), 0.0);
  fading.restart(kStart + 1h);
  EXPECT_EQ(fading.opacity(kStart + 1h + 1s), 1.0);
}

}  // namespace
}  // namespace pleinair::app
