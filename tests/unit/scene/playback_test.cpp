#include <gtest/gtest.h>

#include "pipeline/scene/models/rig.h"

namespace pleinair::scene {
namespace {

using std::chrono::milliseconds;

Rig twoSeconds() {
  Rig rig;
  rig.clips = {{.name = "still"}, {.name = "walk", .seconds = 2.0}};
  return rig;
}

double secondsOf(const Playback& playback, hal::Duration elapsed) {
  const auto moment = momentOf(twoSeconds(), playback, elapsed);
  EXPECT_TRUE(moment);
  EXPECT_EQ(moment->clip, playback.clip);
  return moment->seconds;
}

TEST(Playback, OfNoClipIsNoMoment) {
  EXPECT_FALSE(momentOf(twoSeconds(), {}, milliseconds(500)));
}

TEST(Playback, LoopsFromEndToBeginning) {
  const Playback walk{.clip = 1};
  EXPECT_DOUBLE_EQ(secondsOf(walk, milliseconds(0)), 0.0);
  EXPECT_DOUBLE_EQ(secondsOf(walk, milliseconds(1999)), 1.999);
  EXPECT_DOUBLE_EQ(secondsOf(walk, milliseconds(2000)), 0.0);
  EXPECT_NEAR(secondsOf(walk, milliseconds(7500)), 1.5, 1e-12);
  EXPECT_NEAR(secondsOf(walk, std::chrono::hours(24 * 365) + milliseconds(500)), 0.5, 1e-6);
}

TEST(Playback, GoesFasterAndBackwards) {
  EXPECT_DOUBLE_EQ(secondsOf({.clip = 1, .speed = 2.0}, milliseconds(750)), 1.5);
  EXPECT_DOUBLE_EQ(secondsOf({.clip = 1, .speed = 0.0}, milliseconds(750)), 0.0);
  EXPECT_DOUBLE_EQ(secondsOf({.clip = 1, .speed = -1.0}, milliseconds(500)), 1.5);
  EXPECT_DOUBLE_EQ(secondsOf({.clip = 1, .speed = -1.0}, milliseconds(2500)), 1.5);
}

TEST(Playback, StaysAtItsEndWhereItDoesNotLoop) {
  const Playback once{.clip = 1, .loops = false};
  EXPECT_DOUBLE_EQ(secondsOf(once, milliseconds(500)), 0.5);
  EXPECT_DOUBLE_EQ(secondsOf(once, milliseconds(2000)), 2.0);
  EXPECT_DOUBLE_EQ(secondsOf(once, std::chrono::hours(1)), 2.0);
  const Playback back{.clip = 1, .speed = -1.0, .loops = false};
  EXPECT_DOUBLE_EQ(secondsOf(back, milliseconds(0)), 2.0);
  EXPECT_DOUBLE_EQ(secondsOf(back, milliseconds(500)), 1.5);
  EXPECT_DOUBLE_EQ(secondsOf(back, milliseconds(9000)), 0.0);
}

TEST(Playback, OfAClipWithoutLengthIsItsOnlyMoment) {
  for (const bool loops : {true, false}) {
    EXPECT_EQ(secondsOf({.clip = 0, .loops = loops}, milliseconds(700)), 0.0);
  }
}

TEST(Playback, NeverLeavesTheClip) {
  for (const double speed : {0.1, 1.0, 3.3, -0.1, -3.3}) {
    for (const bool loops : {true, false}) {
      for (int ms = 0; ms < 10'000; ms += 7) {
        const double seconds =
            secondsOf({.clip = 1, .speed = speed, .loops = loops}, milliseconds(ms));
        ASSERT_GE(seconds, 0.0);
        ASSERT_LE(seconds, 2.0);
      }
    }
  }
}

}  // namespace
}  // namespace pleinair::scene
