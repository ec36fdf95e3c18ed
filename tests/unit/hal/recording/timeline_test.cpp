#include "hal/cameras/recording/timeline.h"

#include <limits>

#include <gtest/gtest.h>

namespace pleinair::hal::recording {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""h;

TEST(Timeline, KeepsSoundTimesExactly) {
  Timeline timeline(40ms);
  EXPECT_EQ(timeline.place(Duration(1'000'000'001), 0), Duration(0));
  EXPECT_EQ(timeline.place(Duration(1'000'000'002), 0), Duration(1));
  EXPECT_EQ(timeline.place(Duration(1'033'333'334), 2), Duration(33'333'333));
  EXPECT_EQ(timeline.correctedCount(), 0u);
}

TEST(Timeline, SpacesMissingTimesByThePeriod) {
  Timeline timeline(40ms);
  EXPECT_EQ(timeline.place(std::nullopt, 0), Duration(0));
  EXPECT_EQ(timeline.place(std::nullopt, 0), 40ms);
  EXPECT_EQ(timeline.place(std::nullopt, 2), 160ms);
  EXPECT_EQ(timeline.place(Duration(5h), 0), 200ms) << "the first sound time joins on";
  EXPECT_EQ(timeline.place(Duration(5h + 33ms), 0), 233ms);
  EXPECT_EQ(timeline.correctedCount(), 3u);
}

TEST(Timeline, MendsADoubledTimeAndIsInTimeAgain) {
  Timeline timeline(40ms);
  timeline.place(Duration(0), 0);
  timeline.place(40ms, 0);
  EXPECT_EQ(timeline.place(40ms, 0), 60ms);
  EXPECT_EQ(timeline.place(80ms, 0), 80ms);
  EXPECT_EQ(timeline.correctedCount(), 1u);
}

TEST(Timeline, GoesOnAfterTheClockWasSet) {
  Timeline timeline(40ms);
  timeline.place(Duration(1h), 0);
  EXPECT_EQ(timeline.place(Duration(0), 0), 40ms);
  EXPECT_EQ(timeline.place(40ms, 0), 80ms);
  EXPECT_EQ(timeline.place(Duration(200h), 0), 120ms);
  EXPECT_EQ(timeline.place(Duration(200h + 7ms), 0), 127ms);
}

TEST(Timeline, SurvivesNonsense) {
  Timeline timeline(40ms);
  EXPECT_EQ(timeline.place(Duration::min(), 0), Duration(0));
  EXPECT_EQ(timeline.place(Duration::max(), 0), 40ms);
  EXPECT_GT(timeline.place(Duration::min(), std::numeric_limits<std::uint64_t>::max()), 40ms);
}

}  // namespace
}  // namespace pleinair::hal::recording
