// How anchors come and go: density with hysteresis, fades without a pop.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/gpu/marks/anchor_life_fixture.h"

namespace pleinair::marks {
namespace {

using tracking::ImageMotion;

TEST_F(AnchorLife, AStillSceneHasNoBirthsAndNoDeathsAndNothingMoves) {
  const std::vector<float> still(300, 0.02F);
  std::vector<glm::vec4> flow(1200);
  const std::vector<Anchor> first = next({});
  for (int i = 0; i < 60; ++i) {
    for (std::size_t k = 0; k < flow.size(); ++k) {  // of a sensor's noise
      const auto phase = static_cast<float>(k + 17U * static_cast<unsigned>(i));
      flow[k] = {0.2F * std::sin(phase), 0.2F * std::cos(1.7F * phase), 0.3F, 0.0F};
    }
    const std::vector<Anchor> now = next(
        {.flow = {.nodes = {40, 30}, .stepPx = glm::vec2(8.0F), .forward = flow, .backward = flow},
         .still = {.fields = {20, 15}, .errorPx = still}});
    ASSERT_EQ(births(now), 0);
    for (std::size_t slot = 0; slot < now.size(); ++slot) {
      ASSERT_EQ(now[slot].isAlive(), first[slot].isAlive());
      if (!now[slot].isAlive()) continue;
      ASSERT_EQ(now[slot].px, first[slot].px);
      ASSERT_EQ(now[slot].seed, first[slot].seed);
      ASSERT_EQ(now[slot].fade, 1.0F);
    }
  }
}

TEST_F(AnchorLife, APanSpawnsOnlyWhatComesIntoThePicture) {
  FadeWatch fades(kIn, kOut);
  next({});
  next(panning(-1.3, 0.4));
  int inside = 0;
  int all = 0;
  int whole = 0;
  for (int i = 0; i < 90; ++i) {
    const std::vector<Anchor> now = next(panning(-1.3, 0.4));
    fades.add(now);
    inside += births(now, 32.0F);
    all += births(now);
    for (const Anchor& each : now) whole += each.isAlive() && each.isBorn() && each.fade == 1.0F;
  }
  EXPECT_GT(all, 500) << "the border that comes in is filled";
  const double there = 2.0 * 32 * 22;  // 32 px and more from the border
  EXPECT_LT(inside / 90.0, 0.005 * there) << "a frame; 5 % would be seen to pop (decision 0014)";
  EXPECT_GT(whole, 20) << "those that come in with the picture are there at once";
  const std::vector<int> counts = cellCounts(set_->read());
  EXPECT_LE(std::ranges::max(counts), 5) << "one above where one goes each frame";
  EXPECT_EQ(std::ranges::count(counts, 0), 0);
  fades.expectNoPop();
}

TEST_F(AnchorLife, APanDoesNotRunOutOfSlots) {
  for (const DensityRule rule : {DensityRule{.target = 1, .birthBelow = 1, .deathAbove = 3},
                                 DensityRule{.target = 4, .birthBelow = 2, .deathAbove = 6}}) {
    set_.emplace(library_, kSize, AnchorOptions{.density = rule});
    for (int i = 0; i < 90; ++i) {
      const std::vector<Anchor> now = next(panning(-0.7, 0.3));
      ASSERT_EQ(std::ranges::count(cellCounts(now), 0), 0)
          << "in frame " << i << " for " << rule.target << " a cell";
    }
  }
}

TEST_F(AnchorLife, ZoomingInSpawnsWhereItGetsSparse) {
  FadeWatch fades(kIn, kOut);
  next({});
  int born = 0;
  for (int i = 0; i < 90; ++i) {
    const std::vector<Anchor> now = next(zooming(1.01));
    fades.add(now);
    born += births(now);
    ASSERT_EQ(std::ranges::count(cellCounts(now), 0), 0) << "in frame " << i;
  }
  EXPECT_GT(born, 1000);
  fades.expectNoPop();
}

TEST_F(AnchorLife, ZoomingOutFadesOutWhatCrowds) {
  FadeWatch fades(kIn, kOut);
  next({});
  double most = 0.0;
  for (int i = 0; i < 90; ++i) {
    const std::vector<Anchor> now = next(zooming(0.99));
    fades.add(now);
    const std::vector<int> counts = cellCounts(now);
    double sum = 0.0;
    for (const int count : counts) sum += count;
    most = std::max(most, sum / static_cast<double>(counts.size()));
  }
  EXPECT_GT(fades.ended(), 300);
  EXPECT_LE(most, 4.0);
  fades.expectNoPop();
}

TEST_F(AnchorLife, DyingOnesDoNotComeBack) {
  next({});
  std::vector<bool> isDying(set_->slotCount(), false);
  int count = 0;
  for (int i = 0; i < 60; ++i) {
    const std::vector<Anchor> now = next(i < 30 ? zooming(0.97) : zooming(1.01));
    for (std::size_t slot = 0; slot < now.size(); ++slot) {
      const bool dies = (now[slot].state & Anchor::kDying) != 0;
      if (!now[slot].isAlive() || now[slot].isBorn()) isDying[slot] = false;
      ASSERT_TRUE(dies || !isDying[slot]);
      count += dies && !isDying[slot] ? 1 : 0;
      isDying[slot] = dies;
    }
  }
  EXPECT_GT(count, 50);
}

}  // namespace
}  // namespace pleinair::marks
