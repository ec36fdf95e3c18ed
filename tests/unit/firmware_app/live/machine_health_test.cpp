// What a hot machine does to the painting, and what is said of it.
#include "firmware_app/live/status/machine_health.h"

#include <chrono>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware_app/live/runtime_rules.h"
#include "tests/support/fake_machine.h"

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class HeatWatchTest : public testing::Test {
 protected:
  void stayAt(double celsius, hal::Duration duration) {
    const hal::MachineState machine{
        .hottest = hal::ThermalZone{.name = "cpu-thermal", .celsius = celsius, .limitCelsius = 80},
        .usedBytes = {},
        .availableBytes = {},
        .diskFreeBytes = {}};
    for (const hal::TimePoint end = now_ + duration; now_ < end; now_ += 5s) {
      const HeatAdvice advice = watch_.update(machine, best_, now_);
      best_ = advice.best;
      if (!advice.notice.empty()) notices_.push_back((advice.isGood ? "+ " : "- ") + advice.notice);
    }
  }

  HeatWatch watch_{heatRules({})};
  hal::TimePoint now_{1h};
  std::size_t best_ = 0;
  std::vector<std::string> notices_;
};

TEST_F(HeatWatchTest, SaysOnceThatItIsHotAndOnceThatItIsCool) {
  stayAt(70, 10min);
  EXPECT_THAT(notices_, IsEmpty());
  EXPECT_EQ(best_, 0u);
  stayAt(77, 2min);
  EXPECT_EQ(best_, qualityNames().size() - 1);
  EXPECT_THAT(notices_,
              ElementsAre("- cpu-thermal is at 77 °C, and the machine slows itself down from 80 °C "
                          "on: quality is lowered until it has cooled"));
  stayAt(60, 10min);
  EXPECT_EQ(best_, 0u);
  ASSERT_EQ(notices_.size(), 2u);
  EXPECT_THAT(notices_.back(), HasSubstr("+ the machine has cooled"));
}

TEST_F(HeatWatchTest, SaysThatAFixedQualityStays) {
  watch_ = HeatWatch(heatRules({.quality = "full"}));
  stayAt(79, 2min);
  EXPECT_EQ(best_, 0u);
  ASSERT_EQ(notices_.size(), 1u);
  EXPECT_THAT(notices_.back(), HasSubstr("the quality is a fixed one"));
}

TEST_F(HeatWatchTest, FollowsTheConfiguredMargin) {
  watch_ = HeatWatch(heatRules({.heatMargin = 12}));
  stayAt(70, 1min);
  EXPECT_GT(best_, 0u);
  best_ = 0;
  watch_ = HeatWatch(heatRules({.heatMargin = 0}));
  stayAt(90, 1min);
  EXPECT_EQ(best_, 0u) << "off";
}

TEST(MachineHealthTest, AdvisesOnceForEachReading) {
  const support::FakeMachine machine;
  machine.setZone(0, "cpu-thermal", 50);
  MachineHealth health(machine.places(), {.levels = 5});
  const auto deadline = std::chrono::steady_clock::now() + 20s;
  while (!health.state() && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
  ASSERT_TRUE(health.state());
  EXPECT_EQ(health.state()->hottest->celsius, 50);
  EXPECT_TRUE(health.update(0, hal::TimePoint(1h)));
  EXPECT_FALSE(health.update(0, hal::TimePoint(1h))) << "the next reading is 5 s away";
}

}  // namespace
}  // namespace pleinair::app
