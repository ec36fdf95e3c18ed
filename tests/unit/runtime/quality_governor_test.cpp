#include "pipeline/runtime/control/quality_governor.h"

#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace pleinair::runtime {
namespace {

using namespace std::chrono_literals;

class QualityGovernorTest : public testing::Test {
 protected:
  static constexpr hal::Duration kPeriod = 33ms;
  static constexpr std::array<double, 5> kCost{1.0, 0.66, 0.44, 0.29, 0.2};

  /// Paints frames whose load is `full` at full quality.
  void run(hal::Duration duration, double full) {
    for (const hal::TimePoint end = now_ + duration; now_ < end; now_ += kPeriod) {
      const std::size_t level = governor_.level();
      governor_.painted(full * kCost.at(level), level, now_);
    }
  }
  std::uint64_t changes() const { return governor_.lowered() + governor_.raised(); }

  hal::TimePoint now_{1h};
  QualityGovernor governor_{{.levels = 5, .pinned = {}}};
};

TEST_F(QualityGovernorTest, KeepsTheBestQualityThatFits) {
  run(60s, 0.9);
  EXPECT_EQ(governor_.level(), 0u);
  EXPECT_EQ(changes(), 0u);
}

TEST_F(QualityGovernorTest, GoesDownWithinAFewFramesUntilItFits) {
  run(5 * kPeriod, 2.0);
  EXPECT_GE(governor_.level(), 1u);
  run(1s, 2.0);
  EXPECT_EQ(governor_.level(), 2u) << "2.0 × 0.44 = 0.88";
  run(60s, 2.0);
  EXPECT_EQ(governor_.level(), 2u) << "and stays: 2.0 × 0.66 does not fit";
  EXPECT_LE(changes(), 2u);
}

TEST_F(QualityGovernorTest, GoesUpAgainOnceThereIsRoom) {
  run(10s, 4.0);
  EXPECT_EQ(governor_.level(), 4u) << "4.0 × 0.29 = 1.16";
  run(30s, 0.5);
  EXPECT_EQ(governor_.level(), 0u);
}

TEST_F(QualityGovernorTest, ForgivesSingleDearFrames) {
  for (int i = 0; i < 1000; ++i, now_ += kPeriod) {
    governor_.painted(i % 10 == 0 ? 3.0 : 0.5, governor_.level(), now_);
  }
  EXPECT_EQ(governor_.level(), 0u);
}

TEST_F(QualityGovernorTest, DoesNotSwingWhereNoLevelSuits) {
  // Level 1 costs 1.05 and level 2 costs 0.5: the usual ratio would expect level 1 to fit.
  for (int i = 0; i < 60 * 30; ++i, now_ += kPeriod) {
    const std::size_t level = governor_.level();
    governor_.painted(level == 0 ? 1.6 : level == 1 ? 1.05 : 0.5, level, now_);
  }
  EXPECT_LE(changes(), 3u) << "it remembers what level 1 cost";
  EXPECT_EQ(governor_.level(), 2u);
}

TEST_F(QualityGovernorTest, TriesMoreAndMoreSeldomWhatDoesNotLast) {
  // Another program loads the machine whenever quality has risen, so no ratio can be measured.
  int raisedFor = 0;
  governor_ = QualityGovernor({.levels = 2, .pinned = {}});
  for (int i = 0; i < 30 * 60 * 10; ++i, now_ += kPeriod) {
    const std::size_t level = governor_.level();
    raisedFor = level == 0 ? raisedFor + 1 : 0;
    governor_.painted(level == 0 ? (raisedFor > 60 ? 1.5 : 0.4) : 0.3, level, now_);
  }
  EXPECT_GT(governor_.raised(), 1u) << "what it learnt may be wrong: it tries";
  EXPECT_LT(governor_.raised(), 15u) << "in ten minutes";
}

TEST_F(QualityGovernorTest, LooksAwayFromFramesOfTheFormerLevel) {
  for (int i = 0; i < 20; ++i, now_ += kPeriod) governor_.painted(1.4, 0, now_);
  EXPECT_EQ(governor_.level(), 1u) << "all 20 were painted at level 0";
}

TEST_F(QualityGovernorTest, StaysWhereItIsPinned) {
  governor_ = QualityGovernor({.levels = 5, .pinned = 1});
  run(10s, 5.0);
  EXPECT_EQ(governor_.level(), 1u);
  EXPECT_TRUE(governor_.isLowest()) << "nothing is left to be lowered";
}

TEST_F(QualityGovernorTest, ALimitLowersAtOnceAndHolds) {
  run(10s, 0.3);
  governor_.limit(2, now_);
  EXPECT_EQ(governor_.level(), 2u);
  EXPECT_EQ(governor_.lowered(), 1u);
  run(5min, 0.3);
  EXPECT_EQ(governor_.level(), 2u) << "though better levels would fit";
  run(1s, 4.0);
  EXPECT_GT(governor_.level(), 2u) << "load lowers further";
  governor_.limit(0, now_);
  run(2min, 0.3);
  EXPECT_EQ(governor_.level(), 0u);
}

TEST_F(QualityGovernorTest, ALimitLeavesAPinnedLevel) {
  governor_ = QualityGovernor({.levels = 5, .pinned = 1});
  governor_.limit(4, now_);
  EXPECT_EQ(governor_.level(), 1u);
  EXPECT_EQ(governor_.best(), 0u) << "nothing is said to be limited";
}

TEST_F(QualityGovernorTest, SettlesUnderNoise) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(1.0, 0.15);
  for (int i = 0; i < 30 * 120; ++i, now_ += kPeriod) {
    const std::size_t level = governor_.level();
    governor_.painted(1.2 * kCost.at(level) * noise(random), level, now_);
  }
  EXPECT_EQ(governor_.level(), 1u);
  EXPECT_LE(changes(), 5u);
}

}  // namespace
}  // namespace pleinair::runtime
