// Anchors on surfaces that are hidden or come into view.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/gpu/marks/anchor_life_fixture.h"

namespace pleinair::marks {
namespace {

using tracking::ImageMotion;

TEST_F(AnchorLife, WhatIsHiddenFadesOutAndWhatComesIntoViewIsFilled) {
  useScene(boxScene());
  const ImageMotion none = panning(0.0, 0.0);
  FadeWatch fades(kIn, kOut);
  next({}, boxAt(100.0));
  next(none, boxAt(100.0));
  for (int i = 1; i <= 40; ++i) {
    const std::vector<Anchor> now = next(none, boxAt(100.0 + 3.0 * i));
    fades.add(now);
    for (const Anchor& each : now) {
      if (!each.isAlive() || each.surface != 0) continue;
      // Well inside the box: nothing of the picture is seen there.
      const bool isBehind = std::abs(each.px.x - (100.0F + 3.0F * static_cast<float>(i))) < 33.0F &&
                            std::abs(each.px.y - 118.0F) < 33.0F;
      ASSERT_FALSE(isBehind && each.isStaying());
    }
  }
  const std::vector<Anchor> last = set_->read();
  const std::vector<int> inImage = cellCounts(last);
  // Where the box began: x 64 … 136, y 82 … 154.
  for (int y = 11; y < 18; ++y) {
    for (int x = 9; x < 16; ++x) {
      EXPECT_GE(inImage.at(static_cast<std::size_t>(y * kGrid.x + x)), 1) << x << ", " << y;
    }
  }
  const std::vector<int> onBox = cellCounts(last, true);
  for (int y = 11; y < 18; ++y) {
    for (int x = 24; x < 30; ++x) {  // it is at x 184 … 256 now
      EXPECT_GE(onBox.at(static_cast<std::size_t>(y * kGrid.x + x)), 1) << x << ", " << y;
    }
  }
  EXPECT_GT(fades.ended(), 50);
  fades.expectNoPop();
}

TEST_F(AnchorLife, WithoutItsPoseAModelsAnchorsFadeOut) {
  useScene(boxScene());
  const ImageMotion none = panning(0.0, 0.0);
  next({}, boxAt(160.0));
  const auto onBox = [](const std::vector<Anchor>& anchors) {
    return std::ranges::count_if(
        anchors, [](const Anchor& each) { return each.isAlive() && each.surface != 0; });
  };
  EXPECT_GT(onBox(next(none, boxAt(160.0))), 100);
  FadeWatch fades(kIn, kOut);
  fades.add(set_->read());
  for (int i = 0; i < 7; ++i) fades.add(next(none));
  EXPECT_EQ(onBox(set_->read()), 0) << "after 200 ms";
  EXPECT_EQ(std::ranges::count(cellCounts(set_->read()), 0), 0);
  fades.expectNoPop();
}

}  // namespace
}  // namespace pleinair::marks
