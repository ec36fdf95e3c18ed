#include "firmware_app/live/screens/rescue_back_off.h"

#include <filesystem>
#include <fstream>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;

class RescueBackOffTest : public testing::Test {
 protected:
  /// A rescue picture, after which the service stays up for a while and fails again.
  hal::Duration rescue(hal::Duration serviceLasts) {
    // Another process each time.
    const hal::Duration time = RescueBackOff(file_).begin(2min, now_);
    now_ += time + serviceLasts;
    return time;
  }

  support::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "back-off";
  hal::TimePoint now_{40s};
};

TEST_F(RescueBackOffTest, DoublesWhileTheServiceFails) {
  std::vector<hal::Duration> times(7);
  for (hal::Duration& each : times) each = rescue(3min);
  EXPECT_THAT(times, ElementsAre(2min, 4min, 8min, 16min, 30min, 30min, 30min));
}

TEST_F(RescueBackOffTest, BeginsAnewAfterTheServiceHasRecovered) {
  rescue(3min);
  rescue(10min);
  EXPECT_EQ(rescue(3min), 2min);
  EXPECT_EQ(rescue(3min), 4min);
}

TEST_F(RescueBackOffTest, IsTheSameForAPictureThatWasItselfRestarted) {
  rescue(3min);
  EXPECT_EQ(RescueBackOff(file_).begin(2min, now_), 4min);
  now_ += 1min;
  EXPECT_EQ(RescueBackOff(file_).begin(2min, now_), 4min);
}

TEST_F(RescueBackOffTest, IsTheShortestWithoutAFileThatCanBeRead) {
  std::ofstream(file_) << "nonsense";
  EXPECT_EQ(rescue(1s), 2min);
  const RescueBackOff nowhere(folder_.path() / "no" / "folder");
  EXPECT_EQ(nowhere.begin(2min, now_), 2min);
  EXPECT_EQ(nowhere.begin(2min, now_ + 2min), 2min);
}

TEST_F(RescueBackOffTest, IsNeverShorterThanAskedFor) {
  EXPECT_EQ(RescueBackOff(file_).begin(60min, now_), 60min);
  EXPECT_EQ(RescueBackOff(file_).begin(60min, now_ + 61min), 60min);
}

}  // namespace
}  // namespace pleinair::app
