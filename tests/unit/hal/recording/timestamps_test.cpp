#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/media_files.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::hal {
namespace {

using std::chrono_literals::operator""min;
using std::chrono_literals::operator""us;
using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;

class Timestamps : public testing::TestWithParam<std::string> {};

TEST_P(Timestamps, OfVariableRateComeBackToTheMicrosecond) {
  const support::TemporaryFolder folder;
  const auto path = folder.path() / GetParam();
  std::vector<Duration> times = {0us, 33'333us, 33'334us, 100'001us, 1s + 7us, 1s + 40'007us};
  // Long enough for several key frames and, in Matroska, many clusters.
  for (int i = 0; i < 150; ++i) times.push_back(times.back() + 16'683us + i * 1us);
  times.push_back(times.back() + 30min);
  support::writeMedia(path, static_cast<int>(times.size()), {32, 32}, times);
  const Result<support::Played> played = support::play(path);
  ASSERT_TRUE(played) << played.error().message();
  ASSERT_EQ(played->times.size(), times.size());
  for (std::size_t i = 0; i < times.size(); ++i) EXPECT_EQ(played->times[i], times[i]) << i;
  EXPECT_EQ(played->dropped, 0u);
  ASSERT_TRUE(std::holds_alternative<EndOfStream>(played->ending));
  const auto& end = std::get<EndOfStream>(played->ending);
  EXPECT_FALSE(end.truncated) << end.truncated->message();
}

INSTANTIATE_TEST_SUITE_P(Containers, Timestamps, testing::Values("a.mp4", "a.mkv"),
                         [](const auto& container) { return container.param.substr(2); });

TEST(Y4mTimestamps, FollowTheNominalRate) {
  const support::TemporaryFolder folder;
  const auto path = folder.path() / "a.y4m";
  support::writeMedia(path, 3, {32, 32}, {0ms, 1ms, 2ms});  // nominal: 40 ms
  const Result<support::Played> played = support::play(path);
  ASSERT_TRUE(played) << played.error().message();
  EXPECT_THAT(played->times, testing::ElementsAre(0ms, 40ms, 80ms));
  EXPECT_EQ(played->format.framePeriod, Duration(40ms));
}

TEST(PictureTimestamps, FollowTheOption) {
  const support::TemporaryFolder folder;
  support::writeMedia(folder.path() / "%d.png", 3);
  const Result<support::Played> played = support::play(folder.path(), {.picturePeriod = 250ms});
  ASSERT_TRUE(played) << played.error().message();
  EXPECT_THAT(played->times, testing::ElementsAre(0ms, 250ms, 500ms));
}

TEST(Looping, GoesOnInSequenceAndTime) {
  const support::TemporaryFolder folder;
  const auto path = folder.path() / "a.mp4";
  support::writeMedia(path, 3);
  const Result<support::Played> played = support::play(path, {.loop = true}, 8);
  ASSERT_TRUE(played) << played.error().message();
  ASSERT_EQ(played->times.size(), 8u);
  for (int i = 0; i < 8; ++i) {
    EXPECT_EQ(played->times[static_cast<std::size_t>(i)], i * 40ms);
    EXPECT_EQ(played->frames[static_cast<std::size_t>(i)].sequence, static_cast<unsigned>(i));
  }
}

}  // namespace
}  // namespace pleinair::hal
