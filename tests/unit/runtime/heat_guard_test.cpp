// What heat does to the quality: from the kernel's files to the level in force.
#include "pipeline/runtime/control/heat_guard.h"

#include <chrono>
#include <optional>

#include <gtest/gtest.h>

#include "hal/machine/machine_state.h"
#include "pipeline/runtime/control/quality_governor.h"
#include "tests/support/fake_machine.h"

namespace pleinair::runtime {
namespace {

using namespace std::chrono_literals;

class HeatGuardTest : public testing::Test {
 protected:
  static constexpr hal::Duration kReading = 5s;

  /// Readings of the same distance to the limit.
  void stay(std::optional<double> marginKelvin, hal::Duration duration, std::size_t level = 0) {
    for (const hal::TimePoint end = now_ + duration; now_ < end; now_ += kReading) {
      changes_ += guard_.update(marginKelvin, level, now_) ? 1 : 0;
    }
  }

  hal::TimePoint now_{1h};
  HeatGuard guard_{{.levels = 5}};
  int changes_ = 0;
};

TEST_F(HeatGuardTest, LeavesACoolMachineAlone) {
  stay(30, 1h);
  stay(5, 1h);
  EXPECT_EQ(guard_.best(), 0u);
  EXPECT_EQ(changes_, 0);
  EXPECT_FALSE(guard_.isHot());
}

TEST_F(HeatGuardTest, TakesALevelAwayEachTenSecondsThatItIsTooHot) {
  stay(4.9, 10s);
  EXPECT_EQ(guard_.best(), 0u) << "a moment";
  stay(4.9, 5s);
  EXPECT_EQ(guard_.best(), 1u);
  EXPECT_TRUE(guard_.isHot());
  stay(4.9, 10s);
  EXPECT_EQ(guard_.best(), 2u);
  stay(-3, 10min);
  EXPECT_EQ(guard_.best(), 4u) << "the lowest there is";
  EXPECT_EQ(changes_, 4);
}

TEST_F(HeatGuardTest, ForgivesSinglePeaks) {
  for (int i = 0; i < 100; ++i) {
    stay(2, 5s);
    stay(7, 5s);
  }
  EXPECT_EQ(changes_, 0);
  EXPECT_FALSE(guard_.isHot());
}

TEST_F(HeatGuardTest, StaysBetweenBothMargins) {
  stay(3, 15s);
  ASSERT_EQ(guard_.best(), 1u);
  stay(9.9, 1h);
  EXPECT_EQ(guard_.best(), 1u);
  EXPECT_TRUE(guard_.isHot());
}

TEST_F(HeatGuardTest, GivesALevelBackForEachCoolMinute) {
  stay(3, 25s);
  ASSERT_EQ(guard_.best(), 2u);
  stay(10, 1min);
  EXPECT_EQ(guard_.best(), 2u);
  stay(10, 5s);
  EXPECT_EQ(guard_.best(), 1u);
  EXPECT_TRUE(guard_.isHot());
  stay(10, 1min);
  EXPECT_EQ(guard_.best(), 0u);
  EXPECT_FALSE(guard_.isHot());
  stay(10, 1h);
  EXPECT_EQ(changes_, 4);
}

TEST_F(HeatGuardTest, BeginsAtTheLevelThatLoadHasLoweredTo) {
  stay(3, 15s, 2);
  EXPECT_EQ(guard_.best(), 3u) << "a level that is not in force would cool nothing";
}

TEST_F(HeatGuardTest, ASensorThatHasGoneKeepsNothingLow) {
  stay(3, 25s);
  ASSERT_EQ(guard_.best(), 2u);
  stay({}, 3min);
  EXPECT_EQ(guard_.best(), 0u);
}

TEST_F(HeatGuardTest, DoesNothingWithoutAMargin) {
  guard_ = HeatGuard({.levels = 5, .marginKelvin = 0});
  stay(-20, 1h);
  EXPECT_EQ(changes_, 0);
  EXPECT_FALSE(guard_.isHot());
}

TEST_F(HeatGuardTest, SaysThatItIsHotWhereNothingCanBeLowered) {
  guard_ = HeatGuard({.levels = 1});
  stay(3, 1min);
  EXPECT_EQ(guard_.best(), 0u);
  EXPECT_EQ(changes_, 0);
  EXPECT_TRUE(guard_.isHot());
}

TEST(HeatAndLoad, AHotMachineIsPaintedAtALowerLevelUntilItHasCooled) {
  const support::FakeMachine machine;
  hal::MachineWatch watch(machine.places());
  HeatGuard guard({.levels = 5});
  QualityGovernor governor({.levels = 5, .pinned = {}});
  hal::TimePoint now{1h};
  const auto paintAt = [&](int celsius, hal::Duration duration) {
    machine.setZone(0, "cpu-thermal", celsius);
    machine.setTrip(0, 0, "passive", 85);
    const hal::TimePoint end = now + duration;
    for (hal::TimePoint reading = now; now < end; now += 33ms) {
      governor.painted(0.3, governor.level(), now);
      if (now < reading) continue;
      reading = now + 5s;
      const hal::MachineState state = watch.read();
      guard.update(state.hottest->marginCelsius(), governor.level(), now);
      governor.limit(guard.best(), now);
    }
  };
  paintAt(70, 5min);
  EXPECT_EQ(governor.level(), 0u);
  paintAt(81, 13s);
  EXPECT_EQ(governor.level(), 1u) << "before the limit, and though there is time for more";
  paintAt(81, 15s);
  EXPECT_EQ(governor.level(), 2u);
  paintAt(77, 5min);
  EXPECT_EQ(governor.level(), 2u) << "it would only be hot again";
  paintAt(70, 70s);
  EXPECT_EQ(governor.level(), 1u);
  paintAt(70, 70s);
  EXPECT_EQ(governor.level(), 0u);
}

}  // namespace
}  // namespace pleinair::runtime
