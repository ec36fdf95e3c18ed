// Readings of the machine on a thread of their own.
#include "hal/machine/machine_monitor.h"

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/support/fake_machine.h"

namespace pleinair::hal {
namespace {

using namespace std::chrono_literals;

/// In real time: it is a thread's.
bool comesTrue(const std::function<bool()>& condition) {
  const auto deadline = std::chrono::steady_clock::now() + 20s;
  while (std::chrono::steady_clock::now() < deadline) {
    if (condition()) return true;
    std::this_thread::yield();
  }
  return false;
}

TEST(MachineMonitorTest, ReadsAgainAndAgain) {
  const support::FakeMachine machine;
  machine.setZone(0, "cpu-thermal", 50);
  const auto monitor = monitorMachine(machine.places(), 1ms);
  const auto reads = [&monitor](double celsius) {
    const auto reading = monitor->latest();
    return reading && reading->value.hottest && reading->value.hottest->celsius == celsius;
  };
  EXPECT_TRUE(comesTrue([&] { return reads(50); }));
  machine.setZone(0, "cpu-thermal", 70);
  EXPECT_TRUE(comesTrue([&] { return reads(70); }));
  EXPECT_GE(monitor->latest()->number, 2U);
}

TEST(MachineMonitorTest, ReadsNothingBetweenTwoReadings) {
  const support::FakeMachine machine;
  const auto monitor = monitorMachine(machine.places(), 1h);
  ASSERT_TRUE(comesTrue([&] { return monitor->latest().has_value(); }));
  EXPECT_EQ(monitor->latest()->number, 1U);
}

TEST(MachineMonitorTest, EndsWhileASensorHangs) {
  const support::FakeMachine machine;
  machine.setZone(0, "cpu-thermal", 50);
  const std::filesystem::path sensor = machine.path() / support::FakeMachine::zoneOf(0) / "temp";
  std::filesystem::remove(sensor);
  ASSERT_EQ(::mkfifo(sensor.c_str(), 0600), 0);  // nobody writes: opening it waits
  const auto began = std::chrono::steady_clock::now();
  {
    const auto monitor = monitorMachine(machine.places(), 1ms);
    EXPECT_FALSE(monitor->latest().has_value());
  }
  EXPECT_LT(std::chrono::steady_clock::now() - began, 5s);
  // Lets the thread go on, which ends then.
  const int writer = ::open(sensor.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  ASSERT_GE(writer, 0);
  EXPECT_EQ(::write(writer, "50000\n", 6), 6);
  ::close(writer);
}

}  // namespace
}  // namespace pleinair::hal
