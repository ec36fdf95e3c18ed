// Anchors on surfaces that are hidden or come into view.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <ranges>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/scene/description/model_source.h"
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

/// The image's anchors go on behind a model: what it uncovers is painted with the same strokes.
TEST_F(AnchorLife, BehindAModelTheImagesAnchorsStayForStylesThatClip) {
  const ImageMotion none = panning(0.0, 0.0);
  const auto passes = [&](bool underModels) {
    hold_.underModels = underModels;
    useScene(boxScene());
    next({});
    const std::vector<Anchor> before = next(none);
    int covered = 0;
    int born = 0;
    for (int i = 0; i <= 30; ++i) {
      for (const Anchor& each : next(none, boxAt(60.0 + 6.0 * i))) {
        covered += each.isCovered() ? 1 : 0;
        born += each.isBorn() && each.surface == 0 ? 1 : 0;
      }
    }
    next(none);
    const std::vector<Anchor> after = next(none);
    int same = 0;
    int all = 0;
    for (std::size_t slot = 0; slot < after.size(); ++slot) {
      if (!before[slot].isStaying()) continue;
      ++all;
      const bool isSame = after[slot].isStaying() && after[slot].seed == before[slot].seed;
      same += isSame && after[slot].fade == before[slot].fade && after[slot].px == before[slot].px
                  ? 1
                  : 0;
    }
    return std::array{covered, born, all - same};
  };
  const auto [covered, born, lost] = passes(true);
  EXPECT_GT(covered, 3000);
  EXPECT_EQ(born, 0);
  const auto [control, bornAnew, replaced] = passes(false);
  EXPECT_EQ(control, 0);
  EXPECT_GT(bornAnew, 200);
  EXPECT_GT(replaced, 200);
  EXPECT_LT(10 * lost, replaced) << "in cells that show both, one of them may be too many";
}

/// They keep their density, and are forgotten with a fade.
TEST_F(AnchorLife, BehindAModelAnchorsAreNeitherCrowdedNorKeptForEver) {
  hold_.underModels = true;
  hold_.memory = std::chrono::milliseconds(900);
  useScene(boxScene());
  const ImageMotion zoom = zooming(1.0 / 1.01);
  next({}, boxAt(160.0));
  const auto inOneCell = [](const std::vector<Anchor>& anchors) {
    std::map<std::pair<int, int>, int> counts;
    for (const Anchor& each : anchors) {
      const glm::ivec2 cell(glm::floor(each.px / 8.0F));
      const bool counted = each.surface == 0 && (each.isStaying() || each.isCovered());
      counts[{cell.x, cell.y}] += counted ? 1 : 0;
    }
    return std::ranges::max(counts | std::views::values);
  };
  FadeWatch fades(kIn, kOut);
  int covered = 0;
  for (int i = 0; i < 30; ++i) {
    const std::vector<Anchor> now = next(zoom, boxAt(160.0));
    fades.add(now);
    EXPECT_LE(inOneCell(now), 7);
    covered += static_cast<int>(std::ranges::count_if(now, &Anchor::isCovered));
  }
  EXPECT_GT(covered, 100);
  for (int i = 0; i < 35; ++i) fades.add(next(panning(0.0, 0.0), boxAt(160.0)));
  EXPECT_EQ(std::ranges::count_if(set_->read(), &Anchor::isCovered), 0);
  EXPECT_GT(fades.ended(), 50);
  fades.expectNoPop();
}

/// Of a gearbox that comes nearer by 1 % a frame, an anchor that is hidden is behind something: it
/// does not come back in the next frames.
TEST_F(AnchorLife, AlongEdgesNoAnchorIsHiddenInEveryOtherFrame) {
  scene::Scene scene;
  scene::SceneModel gearbox;
  gearbox.model = std::make_shared<const scene::Model>(
      scene::modelOf(scene::GearboxSource{.lengthMetres = 0.5, .inputRevolutions = 0}).value());
  scene.models.push_back(std::move(gearbox));
  useScene(scene);
  const auto from = [](double metres) {
    const glm::dmat4 away = glm::translate(glm::dmat4(1.0), {0.0, 0.08, metres});
    return scene::PoseSet{.cameraFromWorld = glm::rotate(glm::rotate(away, 1.9, {1.0, 0.0, 0.0}),
                                                         0.4, {0.0, 0.0, 1.0})};
  };
  constexpr int kFrames = 24;
  std::vector<int> hiddenAt;
  int hidden = 0;
  int back = 0;
  int staying = 0;
  double metres = 0.75;
  std::vector<Anchor> before = next({}, from(metres));
  for (int i = 1; i <= kFrames; ++i) {
    metres *= 0.99;
    const std::vector<Anchor> now = next(panning(0.0, 0.0), from(metres));
    hiddenAt.resize(now.size(), -kFrames);
    for (std::size_t slot = 0; slot < now.size(); ++slot) {
      const Anchor& each = now[slot];
      if (each.surface == 0 || each.seed != before[slot].seed || each.isBorn()) continue;
      const bool isHidden = each.isAlive() && (each.state & Anchor::kHidden) != 0;
      staying += each.isStaying() ? 1 : 0;
      if (isHidden && before[slot].isStaying()) {
        ++hidden;
        hiddenAt[slot] = i;
      }
      back += each.isStaying() && !before[slot].isStaying() && i - hiddenAt[slot] <= 2 ? 1 : 0;
    }
    before = now;
  }
  RecordProperty("anchors", staying / kFrames);
  RecordProperty("hidden", hidden);
  RecordProperty("back", back);
  EXPECT_GT(staying, 500 * kFrames);
  EXPECT_GT(hidden, 20) << "parts do hide others";
  EXPECT_LT(1000 * back, 4 * staying);
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
