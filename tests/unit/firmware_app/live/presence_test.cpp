#include "firmware_app/live/interaction/presence.h"

#include <chrono>

#include <gtest/gtest.h>

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;

constexpr hal::TimePoint kBegin{100s};

TEST(Presence, IsNobodyWithoutACamera) {
  Presence presence;
  EXPECT_FALSE(presence.update({}));
  EXPECT_FALSE(presence.update({.painted = 0})) << "nothing is going to be painted";
}

TEST(Presence, IsAnyKey) {
  Presence presence;
  EXPECT_TRUE(presence.update({.anyKey = true}));
  EXPECT_FALSE(presence.update({}));
}

TEST(Presence, IsAMovementOnce) {
  Presence presence;
  EXPECT_TRUE(presence.update({.movedAt = kBegin, .painted = 7}));
  EXPECT_FALSE(presence.update({.movedAt = kBegin, .painted = 8}));
  EXPECT_TRUE(presence.update({.movedAt = kBegin + 1s, .painted = 9}));
}

TEST(Presence, LastsFromTheFirstFrameToTheFirstPainting) {
  Presence presence;
  EXPECT_TRUE(presence.update({.movedAt = kBegin, .painted = 0}));
  EXPECT_TRUE(presence.update({.movedAt = kBegin, .painted = 0}));
  EXPECT_FALSE(presence.update({.movedAt = kBegin, .painted = 1}));
}

}  // namespace
}  // namespace pleinair::app
