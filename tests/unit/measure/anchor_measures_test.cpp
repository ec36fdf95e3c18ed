#include "pipeline/measure/anchor_measures.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace pleinair::measure {
namespace {

using marks::Anchor;

const cv::Size kSize(320, 240);

Anchor anchorAt(float x, float y, std::uint32_t seed) {
  return {.px = {x, y}, .fade = 1.0F, .seed = seed, .state = Anchor::kAlive};
}

/// One at the centre of each 8×8 cell.
std::vector<Anchor> oneACell() {
  std::vector<Anchor> anchors;
  for (int y = 0; y < kSize.height / 8; ++y) {
    for (int x = 0; x < kSize.width / 8; ++x) {
      anchors.push_back(anchorAt(static_cast<float>(8 * x + 4), static_cast<float>(8 * y + 4),
                                 static_cast<std::uint32_t>(anchors.size() + 1)));
    }
  }
  return anchors;
}

std::vector<Anchor> movedBy(std::vector<Anchor> anchors, glm::vec2 by) {
  for (Anchor& anchor : anchors) anchor.px += by;
  return anchors;
}

TEST(AnchorMeasures, ReadsNoTurnoverWhereNothingHappens) {
  AnchorMeasures measures(kSize);
  const std::vector<Anchor> anchors = oneACell();
  for (int i = 0; i < 5; ++i) measures.add(anchors, nullptr, nullptr);
  const auto all = measures.total();
  ASSERT_TRUE(all);
  EXPECT_EQ(all->frames, 4u);
  EXPECT_EQ(all->alive, 1200);
  EXPECT_EQ(all->births + all->deaths + all->moved, 0);
  EXPECT_FALSE(all->halfLifeFrames);
  EXPECT_FALSE(all->drift);
  EXPECT_EQ(all->perCell, 1.0);
  EXPECT_EQ(all->spreadPerCell, 0.0);
  EXPECT_EQ(all->emptyCellsPercent, 0.0);
}

TEST(AnchorMeasures, CountsBirthsAndDeathsHereAndAwayFromTheBorder) {
  AnchorMeasures measures(kSize);
  std::vector<Anchor> anchors = oneACell();
  anchors.resize(anchors.size() + 8);  // free slots
  measures.add(anchors, nullptr, nullptr);
  anchors[1200] = anchorAt(160, 120, 9001);  // born in the middle
  anchors[1200].state |= Anchor::kBorn;
  anchors[1201] = anchorAt(3, 3, 9002);  // and at the border
  anchors[1201].state |= Anchor::kBorn;
  anchors[0].state = 0;                                           // died at the border
  anchors[15 * 40 + 20].state = Anchor::kAlive | Anchor::kDying;  // dies in the middle
  anchors[15 * 40 + 21].state = Anchor::kAlive | Anchor::kHidden;
  anchors[15 * 40 + 22].seed = 9003;  // the slot of a dead anchor is reused: a death and a birth
  measures.add(anchors, nullptr, nullptr);
  const AnchorFrame& frame = measures.frames().back();
  EXPECT_EQ(frame.births, 3u);
  EXPECT_EQ(frame.innerBirths, 2u);
  EXPECT_EQ(frame.deaths, 4u);
  EXPECT_EQ(frame.innerDeaths, 3u);
  EXPECT_EQ(frame.alive, 1201u);
}

TEST(AnchorMeasures, TellsTheHalfLifeFromTheDeaths) {
  AnchorMeasures measures(kSize);
  std::vector<Anchor> anchors = oneACell();
  measures.add(anchors, nullptr, nullptr);
  // In each frame a tenth of the inner anchors is replaced.
  std::uint32_t seed = 10'000;
  for (int frame = 0; frame < 10; ++frame) {
    for (std::size_t i = static_cast<std::size_t>(frame); i < anchors.size(); i += 10) {
      anchors[i].seed = ++seed;
    }
    measures.add(anchors, nullptr, nullptr);
  }
  const auto all = measures.total();
  ASSERT_TRUE(all && all->halfLifeFrames);
  EXPECT_NEAR(*all->halfLifeFrames, std::log(0.5) / std::log(0.9), 0.01);
  EXPECT_NEAR(all->innerTurnoverPercent, 20, 0.01);  // births and deaths
}

TEST(AnchorMeasures, TellsNoHalfLifeThatIsLongerThanWhatWasSeen) {
  AnchorMeasures measures(kSize);
  std::vector<Anchor> anchors = oneACell();
  measures.add(anchors, nullptr, nullptr);
  anchors[15 * 40 + 20].seed = 10'000;  // one of many
  for (int frame = 0; frame < 5; ++frame) measures.add(anchors, nullptr, nullptr);
  const auto all = measures.total();
  ASSERT_TRUE(all);
  EXPECT_GT(all->innerDeaths, 0);
  EXPECT_FALSE(all->halfLifeFrames);
}

TEST(AnchorMeasures, ReadsTheSlipAgainstTheTrueMotion) {
  AnchorMeasures measures(kSize);
  std::vector<Anchor> anchors = oneACell();
  const MotionMap step = constantMap(kSize, {-1.5, -0.5});
  const MotionMap steps = constantMap(kSize, {-15, -5});
  measures.add(anchors, nullptr, nullptr);
  for (int i = 1; i <= 10; ++i) {
    anchors = movedBy(std::move(anchors), {-1.5F + 0.03F, -0.5F + 0.04F});
    measures.add(anchors, &step, i == 10 ? &steps : nullptr);
  }
  const auto all = measures.total();
  ASSERT_TRUE(all && all->drift && all->longDrift);
  EXPECT_NEAR(all->drift->median, 0.05, 1e-4);
  EXPECT_NEAR(all->drift->percentile95, 0.05, 1e-4);
  EXPECT_NEAR(all->drift->rms, 0.05, 1e-4);
  EXPECT_NEAR(all->longDrift->median, 0.5, 1e-3);
  EXPECT_EQ(all->moved, 1200);
}

TEST(AnchorMeasures, ReadsTheSpreadOverCells) {
  AnchorMeasures measures(kSize);
  std::vector<Anchor> anchors = oneACell();
  // The anchors of every other cell move to the next one: 2, 0, 2, 0 …
  for (std::size_t i = 0; i < anchors.size(); i += 2) anchors[i].px.x += 8;
  measures.add(anchors, nullptr, nullptr);
  measures.add(anchors, nullptr, nullptr);
  const auto all = measures.total();
  ASSERT_TRUE(all);
  EXPECT_EQ(all->perCell, 1.0);
  EXPECT_EQ(all->spreadPerCell, 1.0);
  EXPECT_EQ(all->emptyCellsPercent, 50.0);
}

TEST(AnchorMeasures, SaysNothingWithoutAnchors) {
  AnchorMeasures measures(kSize);
  EXPECT_FALSE(measures.total());
  measures.add(oneACell(), nullptr, nullptr);
  EXPECT_FALSE(measures.total());
}

}  // namespace
}  // namespace pleinair::measure
