// Anchors of the picture that a real thing passes over are hidden by their looks, and nothing else
// is.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "tests/gpu/marks/anchor_life_fixture.h"
#include "tests/gpu/marks/wall_and_disc.h"

namespace pleinair::marks {
namespace {

class AnchorAppearance : public AnchorLife {
 protected:
  std::vector<Anchor> see(const View& view, glm::dvec2 step = glm::dvec2(0.0)) {
    picture_ = support::textureOf(seen(view, kSize, ++seed_).view());
    return next(seed_ == 1 ? tracking::ImageMotion{} : panning(step.x, step.y));
  }
  static int hidden(const std::vector<Anchor>& anchors) {
    return static_cast<int>(std::ranges::count_if(anchors, [](const Anchor& each) {
      return each.isAlive() && (each.state & Anchor::kHidden) != 0;
    }));
  }

 private:
  unsigned seed_ = 0;
};

TEST_F(AnchorAppearance, NothingTurnsOverOnAStillSceneWithNoise) {
  see({});
  for (int i = 0; i < 30; ++i) {
    const std::vector<Anchor> now = see({.noiseSigma = 3.0});
    ASSERT_EQ(births(now), 0) << i;
    ASSERT_EQ(hidden(now), 0) << i;
  }
}

TEST_F(AnchorAppearance, APanHidesNothing) {
  const glm::dvec2 step(-1.3, 0.4);
  View view;
  see(view);
  for (int i = 0; i < 30; ++i) {
    view.shift += step;
    ASSERT_EQ(hidden(see(view, step)), 0) << i;
  }
}

TEST_F(AnchorAppearance, LightThatGoesSlowlyHidesNothing) {
  View view;
  see(view);
  for (int i = 0; i < 40; ++i) {
    view.light *= i < 20 ? 0.985 : 1.015;
    ASSERT_EQ(hidden(see(view)), 0) << i;
  }
}

TEST_F(AnchorAppearance, WhatCoversThemForAMomentHidesNothing) {
  see({});
  see({});
  for (int i = 0; i < 12; ++i) {
    const View covered{.disc = {160.0, 120.0}, .radius = i % 4 < 2 ? 50.0 : 0.0};
    ASSERT_EQ(hidden(see(covered)), 0) << i;
  }
}

TEST_F(AnchorAppearance, WhatCoversThemHasItsOwn) {
  see({});
  std::set<std::uint32_t> ofWall;
  for (const Anchor& each : see({})) {
    if (each.isAlive()) ofWall.insert(each.seed);
  }
  const View covered{.disc = {160.0, 120.0}, .radius = 50.0};
  std::vector<Anchor> now;
  for (int i = 0; i < 15; ++i) now = see(covered);  // four to notice, six to fade out
  int onDisc = 0;
  int fromWall = 0;
  for (const Anchor& each : now) {
    const float away = glm::distance(each.px, glm::vec2(160.0F, 120.0F));
    if (!each.isStaying()) continue;
    if (away < 40.0F) {
      ++onDisc;
      fromWall += ofWall.contains(each.seed) ? 1 : 0;
    } else if (away > 60.0F) {
      ASSERT_TRUE(ofWall.contains(each.seed)) << "those beside it stay";
    }
  }
  EXPECT_GT(onDisc, 60) << "it is filled";
  EXPECT_LT(fromWall, onDisc / 20) << "some of the wall is as bright";
  // And back: what was born on the disc does not stay on the wall.
  for (int i = 0; i < 15; ++i) now = see({});
  EXPECT_EQ(hidden(now), 0);
  EXPECT_EQ(std::ranges::count(cellCounts(now), 0), 0);
}

TEST_F(AnchorAppearance, WhoIsSeenAgainSoonComesBack) {
  see({});
  const std::vector<Anchor> before = see({});
  const View covered{.disc = {160.0, 120.0}, .radius = 50.0};
  for (int i = 0; i < 6; ++i) see(covered);
  EXPECT_GT(hidden(set_->read()), 60);
  std::vector<Anchor> now;
  for (int i = 0; i < 14; ++i) now = see({});  // those of the disc have gone, too
  EXPECT_EQ(hidden(now), 0);
  int kept = 0;
  for (std::size_t slot = 0; slot < now.size(); ++slot) {
    const bool wasThere =
        before[slot].isAlive() && glm::distance(before[slot].px, glm::vec2(160.0F, 120.0F)) < 40.0F;
    kept += wasThere && now[slot].isAlive() && now[slot].seed == before[slot].seed ? 1 : 0;
  }
  EXPECT_GT(kept, 60);
}

}  // namespace
}  // namespace pleinair::marks
