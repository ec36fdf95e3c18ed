#include "pipeline/runtime/duration_histogram.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace pleinair::runtime {
namespace {

using namespace std::chrono_literals;

TEST(DurationHistogram, KnowsPercentilesToOnePercent) {
  std::mt19937 random(7);
  std::lognormal_distribution<double> microseconds(9.0, 2.0);
  DurationHistogram histogram;
  std::vector<double> all;
  for (int i = 0; i < 20'000; ++i) {
    const double value = std::min(microseconds(random), 6e7);
    all.push_back(value);
    histogram.add(std::chrono::nanoseconds(static_cast<std::int64_t>(value * 1000)));
  }
  std::ranges::sort(all);
  for (const double share : {0.01, 0.1, 0.5, 0.9, 0.95, 0.99, 0.999, 1.0}) {
    const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(all.size())));
    const double exact = all[rank - 1];
    const double found =
        std::chrono::duration<double, std::micro>(histogram.percentile(share)).count();
    EXPECT_GE(found, exact * 0.999) << share;
    EXPECT_LE(found, exact * 1.009 + 1.0) << share;
  }
  EXPECT_EQ(histogram.count(), 20'000u);
}

TEST(DurationHistogram, TakesWhatIsOutOfItsRange) {
  DurationHistogram histogram;
  EXPECT_EQ(histogram.percentile(0.5), 0s);
  histogram.add(-1s);
  histogram.add(10h);
  EXPECT_LE(histogram.percentile(0.5), 1us);
  EXPECT_EQ(histogram.max(), 10h);
  EXPECT_GT(histogram.percentile(1.0), 50s);
}

TEST(RecentDurations, ForgetsWhatIsOlderThanAMinute) {
  RecentDurations durations;
  hal::TimePoint now{1h};
  durations.add(500ms, now);
  for (int i = 0; i < 70; ++i) {
    now += 1s;
    durations.add(10ms, now);
    if (i < 29) {
      EXPECT_EQ(durations.recent(now).max(), 500ms) << i;
    }
  }
  EXPECT_LE(durations.recent(now).max(), 11ms);
  EXPECT_GE(durations.recent(now).count(), 30u);
  EXPECT_LE(durations.recent(now).count(), 61u);
  EXPECT_EQ(durations.count(), 71u);
  EXPECT_EQ(durations.sum(), 500ms + 70 * 10ms);
  now += 10h;
  durations.add(7ms, now);
  EXPECT_EQ(durations.recent(now).count(), 1u) << "after a long silence all is old";
}

TEST(RecentDurations, AgeWhereNothingComesAnyMore) {
  RecentDurations durations;
  const hal::TimePoint begin{1h};
  durations.add(500ms, begin);
  durations.add(10ms, begin + 35s);
  EXPECT_EQ(durations.recent(begin + 36s).max(), 500ms);
  EXPECT_LE(durations.recent(begin + 66s).percentile(0.95), 11ms);
  EXPECT_EQ(durations.recent(begin + 66s).count(), 1u);
  EXPECT_EQ(durations.recent(begin + 96s).count(), 0u);
  EXPECT_EQ(durations.recent(begin + 96s).percentile(0.95), 0s);
  EXPECT_EQ(durations.count(), 2u);
}

}  // namespace
}  // namespace pleinair::runtime
