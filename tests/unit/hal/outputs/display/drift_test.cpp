// Pictures that move by a few pixels, so that nothing burns in.
#include "hal/outputs/display/drift.h"

#include <chrono>
#include <cstdlib>
#include <map>
#include <utility>

#include "tests/unit/hal/outputs/display/display_test.h"

namespace pleinair::support {
namespace {

using namespace std::chrono_literals;
using hal::display::CanvasOffset;
using hal::display::driftAt;

TEST(Drift, BeginsInTheMiddleAndMovesByOnePixelAtATime) {
  EXPECT_EQ(driftAt(0, 3), (CanvasOffset{.x = 3, .y = 3}));
  std::map<std::pair<int, int>, int> visits;
  for (std::uint64_t step = 0; step < 2 * 49; ++step) {
    const CanvasOffset now = driftAt(step, 3);
    const CanvasOffset next = driftAt(step + 1, 3);
    EXPECT_LE(std::abs(next.x - now.x) + std::abs(next.y - now.y), 1) << step;
    EXPECT_TRUE(now.x >= 0 && now.x <= 6 && now.y >= 0 && now.y <= 6);
    ++visits[{now.x, now.y}];
  }
  EXPECT_EQ(visits.size(), 49u) << "all of them";
  for (const auto& [place, count] : visits) EXPECT_EQ(count, 2);
}

TEST(Drift, OfNothingStays) {
  EXPECT_EQ(driftAt(12345, 0), CanvasOffset());
}

class DriftTest : public DisplayTest {
 protected:
  void showFor(hal::Duration duration) {
    for (const auto end = clock_.now() + duration; clock_.now() < end;) {
      ASSERT_TRUE(showAndWait().has_value());
      ASSERT_TRUE(runTo(clock_.now() + 5s).has_value());
    }
  }
};

TEST_F(DriftTest, LargerCanvasesMoveBehindTheDisplay) {
  FakeCardSpec& card = plug();
  const auto format = start("display", {.placement = {.fit = hal::display::Placement::Fit::kFill},
                                        .blanking = {},
                                        .driftPixels = 2});
  ASSERT_TRUE(format.has_value());
  EXPECT_EQ(format->frame.size, (hal::FrameSize{68, 52})) << "2 px are cut off at each edge";
  EXPECT_EQ(std::pair(card.panX, card.panY), std::pair(2, 2));
  showFor(61s);
  EXPECT_EQ(std::abs(card.panX - 2) + std::abs(card.panY - 2), 1) << "a pixel a minute";
  showFor(10min);
  EXPECT_NE(std::pair(card.panX, card.panY), std::pair(2, 2));
  EXPECT_EQ(cards_.modesets, 1) << "without the mode being set anew";
}

TEST_F(DriftTest, FlipsThatDoNotMoveChangeTheFramebufferOnly) {
  plug();
  ASSERT_TRUE(start("display", {.placement = {}, .blanking = {}, .driftPixels = 2}).has_value());
  showFor(50s);
  for (const std::size_t changes : cards_.changesOfFlips) EXPECT_EQ(changes, 1u);
  showFor(20s);
  int moves = 0;
  for (const std::size_t changes : cards_.changesOfFlips) moves += changes == 2 ? 1 : 0;
  EXPECT_EQ(moves, 1);
}

TEST_F(DriftTest, OfACardThatRefusesItPicturesStayWhereTheyAre) {
  FakeCardSpec spec;
  spec.refusesPanning = true;
  FakeCardSpec& card = plug(std::move(spec));
  ASSERT_TRUE(start("display", {.placement = {}, .blanking = {}, .driftPixels = 2}).has_value());
  const std::size_t before = cards_.shown.size();
  showFor(3min);
  EXPECT_EQ(std::pair(card.panX, card.panY), std::pair(2, 2));
  EXPECT_GE(cards_.shown.size() - before, 30u) << "and are shown";
}

TEST_F(DriftTest, IsOffUnlessItIsAsked) {
  FakeCardSpec& card = plug();
  ASSERT_TRUE(start().has_value());
  showFor(3min);
  EXPECT_EQ(std::pair(card.panX, card.panY), std::pair(0, 0));
  for (const std::size_t changes : cards_.changesOfFlips) EXPECT_EQ(changes, 1u);
}

}  // namespace
}  // namespace pleinair::support
