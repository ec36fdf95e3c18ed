// The state of a machine, from files as the kernel writes them.
#include "hal/machine/machine_state.h"

#include <chrono>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "hal/machine/local_time.h"
#include "tests/support/fake_machine.h"

namespace pleinair::hal {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

const std::chrono::system_clock::time_point kToday =
    std::chrono::sys_days(std::chrono::year(2026) / 11 / 24) + 7h;

class MachineTest : public testing::Test {
 protected:
  void write(const fs::path& file, const std::string& text) { machine_.write(file, text); }
  void addZone(int number, const std::string& type, int celsius) {
    machine_.setZone(number, type, celsius);
  }
  void addTrip(int zone, int number, const std::string& type, int celsius) {
    machine_.setTrip(zone, number, type, celsius);
  }
  MachineState read(Duration sinceBoot = 100s) {
    return MachineWatch(places_).read(kToday, sinceBoot);
  }

  support::FakeMachine machine_;
  MachinePlaces places_ = machine_.places();
};

TEST_F(MachineTest, SaysNothingOfWhatIsNotThere) {
  const MachineState state = read();
  EXPECT_FALSE(state.hottest.has_value());
  EXPECT_FALSE(state.usedBytes.has_value());
}

TEST_F(MachineTest, TheHottestSensorIsTheOneNearestToItsLimit) {
  addZone(0, "acpitz", 60);
  addTrip(0, 0, "critical", 110);
  addZone(1, "gpu-thermal", 55);
  addTrip(1, 0, "active", 40);  // a fan
  addTrip(1, 1, "passive", 65);
  addTrip(1, 2, "hot", 70);
  const MachineState state = read();
  ASSERT_TRUE(state.hottest.has_value());
  EXPECT_EQ(state.hottest->name, "gpu-thermal");
  EXPECT_DOUBLE_EQ(state.hottest->celsius, 55);
  EXPECT_DOUBLE_EQ(state.hottest->limitCelsius, 65);
  EXPECT_DOUBLE_EQ(state.hottest->marginCelsius(), 10);
}

TEST_F(MachineTest, ASensorWithoutATripThatSlowsDownHasTheUsualLimit) {
  addZone(0, "cpu-thermal", 50);
  EXPECT_DOUBLE_EQ(read().hottest->limitCelsius, 80);
  addTrip(0, 0, "critical", 110);
  EXPECT_DOUBLE_EQ(read().hottest->limitCelsius, 80) << "firmware slows down before";
  addTrip(0, 0, "critical", 90);
  EXPECT_DOUBLE_EQ(read().hottest->limitCelsius, 75);
}

TEST_F(MachineTest, ReadingsThatNoSensorHasAreLeftOut) {
  addZone(0, "broken", 0);
  write("thermal/thermal_zone0/temp", "-274000");
  addZone(1, "board", 30);
  addTrip(1, 0, "passive", -1);
  ASSERT_TRUE(read().hottest.has_value());
  EXPECT_EQ(read().hottest->name, "board");
  EXPECT_DOUBLE_EQ(read().hottest->limitCelsius, 80);
}

TEST_F(MachineTest, MemoryIsTheMachinesOrWhatTheServicesLimitLeaves) {
  write("meminfo", "MemTotal: 900 kB\nMemAvailable:    500 kB");
  write("self/statm", "1000 25 3 0 0 0 0");
  EXPECT_EQ(read().availableBytes, 500u * 1024);
  EXPECT_GT(*read().usedBytes, 25u * 1024);
  write("self/cgroup", "0::/system.slice/pleinair-kiosk.service");
  write("cgroup/system.slice/pleinair-kiosk.service/memory.max", "400000");
  write("cgroup/system.slice/pleinair-kiosk.service/memory.current", "100000");
  EXPECT_EQ(read().availableBytes, 300'000u);
  write("cgroup/system.slice/pleinair-kiosk.service/memory.max", "max");
  EXPECT_EQ(read().availableBytes, 500u * 1024);
}

TEST_F(MachineTest, AHiddenMeminfoIsNoError) {
  EXPECT_GT(read().availableBytes.value_or(0), 0u) << "the kernel is asked";
}

TEST_F(MachineTest, FreeSpaceIsThatOfTheFolderOfTheState) {
  EXPECT_GT(read().diskFreeBytes.value_or(0), 0u);
  places_.state = machine_.path() / "nowhere";
  EXPECT_FALSE(read().diskFreeBytes.has_value());
}

TEST_F(MachineTest, AClockBeforeTheProgramIsWrong) {
  MachineWatch watch(places_);
  write("synchronized", "");
  EXPECT_EQ(watch.read(kToday, 100s).clock, ClockTrust::kSynchronized);
  EXPECT_EQ(watch.read(std::chrono::system_clock::time_point(3h), 100s).clock, ClockTrust::kWrong);
  EXPECT_FALSE(isPlausible(std::chrono::system_clock::time_point(24h * 365 * 40)));
  EXPECT_TRUE(isPlausible(kToday));
}

TEST_F(MachineTest, CountsJumpsOfTheClockAndNoSlowSetting) {
  MachineWatch watch(places_);
  EXPECT_EQ(watch.read(kToday, 100s).clockJumps, 0u);
  EXPECT_EQ(watch.read(kToday + 5s, 105s).clockJumps, 0u);
  EXPECT_EQ(watch.read(kToday + 11s, 110s).clockJumps, 0u) << "a second is slow setting";
  EXPECT_EQ(watch.read(kToday + 1h, 115s).clockJumps, 1u);
  EXPECT_EQ(watch.read(kToday + 5s, 120s).clockJumps, 2u) << "back";
}

}  // namespace
}  // namespace pleinair::hal
