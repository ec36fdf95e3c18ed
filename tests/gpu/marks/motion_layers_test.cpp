// Movers are told from the background at once, and for as long as they are there; and the anchors
// behind a mover are the same ones when it has passed.
#include "pipeline/marks/movers/motion_layers.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/gpu/marks/motion_layers_fixture.h"

namespace pleinair::marks {
namespace {

TEST_F(MotionLayersTest, AStillSceneHasNoMovers) {
  for (int i = 0; i < 20; ++i) {
    see({.noiseSigma = 3.0});
    ASSERT_EQ(movers(), 0) << i;
  }
}

/// The last cells reach beyond the image.
TEST_F(MotionLayersTest, NorHasOneWithOddSides) {
  constexpr hal::FrameSize kOdd{319, 237};
  field_.emplace(library_, kOdd);
  layers_.emplace(library_, kOdd);
  set_.emplace(library_, kOdd, AnchorOptions{});
  for (int i = 0; i < 20; ++i) {
    see({.noiseSigma = 3.0}, {}, kOdd);
    ASSERT_EQ(movers(), 0) << i;
  }
  const View view{.disc = {280.0, 200.0}, .radius = 30.0};
  see(view, {}, kOdd);
  EXPECT_GT(overlapWith(view).iou(), 0.85);
}

TEST_F(MotionLayersTest, APanHasNone) {
  const glm::dvec2 step(-1.3, 0.4);
  View view;
  see(view);
  for (int i = 0; i < 20; ++i) {
    view.shift += step;
    see(view, step);
    ASSERT_LT(movers(), 10) << i;
  }
}

TEST_F(MotionLayersTest, WhatMovesIsFoundWithItsOutline) {
  see({});
  see({});
  for (int i = 0; i < 15; ++i) {
    const View view{.disc = {60.0 + 12.0 * i, 120.0}, .radius = 35.0};
    see(view);
    // In its first frame no motion of the disc is known, but the picture has changed there.
    ASSERT_GT(overlapWith(view).iou(), 0.85) << i;
  }
  see({});
  EXPECT_LT(movers(), 30)
      << "it is gone at once; a cell in a hundred may have been taken for ground";
}

/// A spot on the wall has the disc's colour in a little less light: by itself, the disc before it
/// counts as a change of light. Where the disc has a hole, the wall is seen.
TEST_F(MotionLayersTest, PartsLikeTheBackgroundAreNoHolesInAMover) {
  constexpr glm::dvec2 kSpot{160.0, 120.0};
  constexpr double kSpotRadius = 9.0;
  constexpr double kLessLight = 0.92;
  const auto picture = [&](const View& view, double holeRadius, unsigned seed) {
    hal::Image image = seen(view, kSize, seed);
    hal::Image wall = seen({}, kSize, seed);
    hal::Image disc = seen({.light = kLessLight, .disc = kSpot, .radius = 40.0}, kSize, seed);
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        const double away = glm::distance(glm::dvec2(x, y), kSpot);
        const bool isDisc = glm::distance(glm::dvec2(x, y), view.disc) < view.radius;
        if (isDisc && away >= holeRadius) continue;
        hal::Image& from = away < kSpotRadius && holeRadius == 0.0 ? disc : wall;
        std::copy_n(from.row(0, y).data() + 4 * x, 4, image.row(0, y).data() + 4 * x);
      }
    }
    return image;
  };
  /// Cells within `radius` of the spot's middle that are a mover's, or are not.
  const auto count = [&](double radius, bool isMover) {
    const std::vector<glm::vec4> labels = texelsOf(layers_->labels());
    const int width = layers_->labels().size().width;
    int found = 0;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      const auto index = static_cast<int>(i);
      const glm::dvec2 px = (glm::dvec2(index % width, index / width) + 0.5) * 2.0;
      found += glm::distance(px, kSpot) < radius && (labels[i].r > 0.5F) == isMover ? 1 : 0;
    }
    return found;
  };
  const View passing{.disc = {150.0, 126.0}, .radius = 40.0};
  unsigned seed = 0;
  for (int i = 0; i < 12; ++i) seeImage(picture({}, 0.0, ++seed));
  for (int i = 0; i < 8; ++i) seeImage(picture(passing, 0.0, ++seed));
  EXPECT_EQ(count(kSpotRadius, false), 0);

  layers_->reset();
  for (int i = 0; i < 12; ++i) seeImage(picture({}, kSpotRadius, ++seed));
  for (int i = 0; i < 8; ++i) seeImage(picture(passing, kSpotRadius, ++seed));
  EXPECT_GT(count(30.0, true), 400);
  EXPECT_EQ(count(kSpotRadius - 3.0, true), 0) << "the control: a hole";
}

TEST_F(MotionLayersTest, LabelsAreReadAsTheyAre) {
  see({});
  see({});
  for (int i = 0; i < 6; ++i) see({.disc = {60.0 + 12.0 * i, 120.0}, .radius = 35.0});
  const std::vector<glm::vec4> labels = texelsOf(layers_->labels());
  hal::Image read = layers_->readMovers();
  ASSERT_EQ(read.size(), layers_->labels().size());
  std::size_t movers = 0;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    EXPECT_EQ(read.plane(0)[i], labels[i].r > 0.5F ? 255 : 0) << i;
    movers += read.plane(0)[i] != 0 ? 1 : 0;
  }
  EXPECT_GT(movers, 500u);
}

TEST_F(MotionLayersTest, WhatComesToRestStaysItselfForAWhile) {
  see({});
  View view{.radius = 35.0};
  for (int i = 0; i < 10; ++i) {
    view.disc = {60.0 + 10.0 * i, 120.0};
    see(view);
  }
  // The motion of the disc is not measured here, so that it joins the background after 0.7 s.
  for (int i = 0; i < 18; ++i) see(view);
  EXPECT_GT(overlapWith(view).iou(), 0.8);
  for (int i = 0; i < 8; ++i) see(view);
  EXPECT_EQ(movers(), 0);
}

/// A disc that was seen to move counts as a mover for MotionLayersOptions::rest.
TEST_F(MotionLayersTest, AMoverThatRestsJoinsTheBackgroundAfterFifteenSeconds) {
  see({});
  see({});
  View view{.radius = 35.0};
  for (int i = 0; i < 12; ++i) {
    view.disc = {60.0 + 8.0 * i, 120.0};
    seeDiscMoved(view, {8.0, 0.0});
  }
  rest(view, std::chrono::milliseconds(14200));
  EXPECT_GT(overlapWith(view).iou(), 0.8);
  rest(view, std::chrono::milliseconds(1800));
  EXPECT_EQ(movers(), 0);
}

/// It creeps before it rests: no motion is measured of what it covers last, which is as good as new
/// there. It must not be remembered as the wall.
TEST_F(MotionLayersTest, WhatAMoverCoversLastIsNotTakenForTheBackground) {
  for (int i = 0; i < 8; ++i) see({});
  const std::vector<glm::vec4> wall = texelsOf(layers_->background());
  // Its rim is of four colours, or it would be taken for what is beside it.
  const auto withRim = [&](const View& view, unsigned seed) {
    hal::Image image = seen(view, kSize, seed);
    for (int y = 0; y < kSize.height; ++y) {
      std::uint8_t* p = image.row(0, y).data();
      for (int x = 0; x < kSize.width; ++x, p += 4) {
        const glm::dvec2 at = glm::dvec2(x, y) - view.disc;
        if (glm::length(at) > view.radius || glm::length(at) < view.radius - 5.0) continue;
        const auto patch = glm::ivec2(glm::floor(at / 4.0)) & 1;
        p[0] = patch.x != 0 ? 250 : 10;
        p[1] = patch.y != 0 ? 200 : 20;
        p[2] = patch.x != patch.y ? 220 : 30;
      }
    }
    return image;
  };
  View view{.radius = 35.0};
  unsigned seed = 100;
  for (int i = 0; i < 12; ++i) {
    view.disc = {60.0 + 8.0 * i, 120.0};
    seeDiscMoved(withRim(view, ++seed), view, {8.0, 0.0}, Texture::kWhole);
  }
  for (int i = 0; i < 10; ++i) {
    view.disc.x += 0.5;
    seeImage(withRim(view, ++seed));
  }
  for (int i = 0; i < 60; ++i) seeImage(withRim(view, ++seed));
  EXPECT_GT(overlapWith(view).iou(), 0.8);
  const std::vector<glm::vec4> remembered = texelsOf(layers_->background());
  const int width = layers_->background().size().width;
  int wrong = 0;
  for (std::size_t i = 0; i < wall.size(); ++i) {
    const auto index = static_cast<int>(i);
    const glm::dvec2 px = 2.0 * (glm::dvec2(index % width, index / width) + 0.5);
    if (glm::distance(px, view.disc) > view.radius - 2.0) continue;
    wrong += glm::distance(glm::vec3(wall[i]), glm::vec3(remembered[i])) > 0.08F ? 1 : 0;
  }
  EXPECT_LE(wrong, 30) << "160 if they join after 0.7 s";
}

/// Like a sleeve: flow is measured at its outline, but for the front.
TEST_F(MotionLayersTest, APlainMoverGoesWithItsOutline) {
  see({});
  see({});
  View view{.radius = 35.0};
  std::vector<float> steps;
  for (int i = 0; i < 12; ++i) {
    view.disc = {60.0 + 8.0 * i, 120.0};
    seeDiscMoved(view, {8.0, 0.0}, Texture::kOutline);
    if (i < 4) continue;
    for (const Anchor& each : set_->read()) {
      const bool isOnDisc =
          each.isStaying() && !each.isBorn() && (each.state & Anchor::kMover) != 0;
      if (isOnDisc && glm::distance(glm::dvec2(each.px), view.disc) < 14.0) {
        steps.push_back(each.displacementPx.x);
      }
    }
  }
  ASSERT_GT(steps.size(), 50u);
  std::ranges::sort(steps);
  EXPECT_NEAR(steps[steps.size() / 10], 8.0F, 3.5F);
  EXPECT_NEAR(steps[steps.size() / 2], 8.0F, 1.0F);
  rest(view, std::chrono::milliseconds(2000));
  EXPECT_GT(overlapWith(view).iou(), 0.65) << "most of it is a mover that rests";
}

/// It is seen for less time than makes what appears within the image a mover.
TEST_F(MotionLayersTest, WhatComesInFromOutsideIsAMoverAtOnce) {
  see({});
  see({});
  View view{.radius = 45.0};
  for (const double x : {-20.0, -4.0, 12.0, 28.0}) {
    view.disc = {x, 120.0};
    seeDiscMoved(view, {16.0, 0.0}, Texture::kOutline);
  }
  rest(view, std::chrono::milliseconds(2000));
  EXPECT_GT(overlapWith(view).iou(), 0.7) << "a mover that rests";
}

/// Flow reaches beyond the disc, and carries nothing there.
TEST_F(MotionLayersTest, BeforeAStandingCameraTheBackgroundRests) {
  for (int i = 0; i < 4; ++i) see({});
  View view{.radius = 35.0};
  int beside = 0;
  for (int i = 0; i < 6; ++i) {
    view.disc = {60.0 + 8.0 * i, 120.0};
    seeDiscMoved(view, {8.0, 0.0});
    for (const Anchor& each : set_->read()) {
      if (!each.isAlive() || each.isBorn() || (each.state & Anchor::kMover) != 0) continue;
      ASSERT_EQ(each.displacementPx, glm::vec2(0.0F));
      beside += glm::distance(glm::dvec2(each.px), view.disc) < 46.0 ? 1 : 0;
    }
  }
  EXPECT_GT(beside, 100);
}

/// The disc has stood there since the camera began to look.
TEST_F(MotionLayersTest, WhatAMoverUncoversForTheFirstTimeIsBackgroundAtOnce) {
  View view{.disc = {100.0, 120.0}, .radius = 35.0};
  for (int i = 0; i < 6; ++i) see(view);
  EXPECT_EQ(movers(), 0);
  view.disc.x = 220.0;
  see(view);
  EXPECT_GT(movers(), 900) << "in its first frame it may be either";
  see(view);
  see(view);
  EXPECT_GT(overlapWith(view).iou(), 0.85) << "only the disc is left";
}

/// Flow that reaches beyond the disc carries its label to what it uncovers, which is known to be
/// the background by what is seen around it.
TEST_F(MotionLayersTest, WhatItUncoversBesideItselfIsBackgroundSoon) {
  for (const int stood : {3, 40}) {
    layers_->reset();
    View view{.disc = {80.0, 120.0}, .radius = 35.0};
    const View place = view;
    for (int i = 0; i < stood; ++i) see(view);
    for (int i = 0; i < 18; ++i) {
      view.disc.x += 8.0;
      seeDiscMoved(view, {8.0, 0.0}, Texture::kOutline);
    }
    const Overlap left = overlapWith(place);
    EXPECT_LT(left.both, left.wanted / 50) << "after it stood there for " << stood << " frames";
    EXPECT_GT(overlapWith(view).iou(), 0.7) << stood;
  }
}

/// The disc appears and does not move at all, like an object that was put down.
TEST_F(MotionLayersTest, AChangeThatThenRestsJoinsTheBackgroundAfterLessThanASecond) {
  for (int i = 0; i < 4; ++i) see({});
  const View view{.disc = {160.0, 120.0}, .radius = 35.0};
  for (int i = 0; i < 20; ++i) see(view);
  EXPECT_GT(overlapWith(view).iou(), 0.8) << "after 0.66 s";
  for (int i = 0; i < 6; ++i) see(view);
  EXPECT_EQ(movers(), 0) << "after 0.86 s";
}

TEST_F(MotionLayersTest, LightIsNoMover) {
  see({});
  see({});
  for (const double light : {0.6, 1.0, 0.8, 0.5, 1.0}) {
    see({.light = light});
    ASSERT_EQ(movers(), 0) << light;
  }
}

TEST_F(MotionLayersTest, TheBackgroundIsRememberedBehindAMover) {
  for (int i = 0; i < 8; ++i) see({});
  const std::vector<glm::vec4> before = texelsOf(layers_->background());
  const View view{.disc = {160.0, 120.0}, .radius = 35.0};
  for (int i = 0; i < 5; ++i) see(view);
  const std::vector<glm::vec4> behind = texelsOf(layers_->background());
  const auto middle = static_cast<std::size_t>(60 * layers_->background().size().width + 80);
  EXPECT_LT(glm::distance(glm::vec3(before[middle]), glm::vec3(behind[middle])), 0.02F);
  EXPECT_GE(behind[middle].a, 5.0F) << "frames in the mean";
}

/// The light of a part, brighter or darker, with the same structure.
TEST_F(MotionLayersTest, AShadowIsNoMover) {
  see({});
  see({});
  for (const double light : {0.8, 0.9, 1.0}) {
    hal::Image shaded = seen({.noiseSigma = 1.0}, kSize, 77);
    for (int y = 60; y < 180; ++y) {
      for (int x = 80; x < 200; ++x) {
        auto* p = shaded.row(0, y).data() + std::ptrdiff_t{4} * x;
        for (int c = 0; c < 3; ++c) p[c] = static_cast<std::uint8_t>(light * p[c]);
      }
    }
    seeImage(shaded);
    ASSERT_LT(movers(), 60) << "of 3600 cells: its edge " << light;
  }
}

/// A wall above a plain table, two fifths of which are lit by a lamp.
hal::Image litByLamp(double lamp, hal::FrameSize size, unsigned seed) {
  hal::Image image = seen({.noiseSigma = 1.0}, size, seed);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      auto* p = image.row(0, y).data() + std::ptrdiff_t{4} * x;
      const bool isTable = y > size.height / 2;
      const double light = x > 3 * size.width / 5 ? lamp : 1.0;
      for (int c = 0; c < 3; ++c) {
        p[c] = static_cast<std::uint8_t>(std::min(light * (isTable ? 90.0 : 0.6 * p[c]), 255.0));
      }
    }
  }
  return image;
}

TEST_F(MotionLayersTest, ALampThatIsSwitchedIsNoMover) {
  for (unsigned i = 0; i < 4; ++i) seeImage(litByLamp(1.0, kSize, i));
  for (const double lamp : {1.6, 1.0, 1.4}) {
    for (unsigned i = 0; i < 3; ++i) {
      seeImage(litByLamp(lamp, kSize, 10 + i));
      ASSERT_EQ(movers(), 0) << lamp << ", frame " << i;
    }
  }
}

/// Models are drawn over the picture, and are no part of it.
TEST_F(MotionLayersTest, AModelIsNoMoverNorIsWhatItUncovers) {
  useScene(boxScene());
  for (int i = 0; i < 20; ++i) {
    see({}, {}, kSize, boxAt(80.0 + 6.0 * i));
    ASSERT_LT(movers(), 40) << i << ": it uncovers over 100 cells in each frame";
  }
}

TEST_F(MotionLayersTest, ACutForgetsTheBackground) {
  see({});
  see({});
  sequence_ += 10;  // the motion is not since the last frame
  see({.disc = {160.0, 120.0}, .radius = 35.0});
  EXPECT_EQ(movers(), 0);
  see({});
  layers_->reset();
  see({.disc = {160.0, 120.0}, .radius = 35.0});
  EXPECT_EQ(movers(), 0) << "nor does a reset keep it";
}

TEST_F(MotionLayersTest, AnchorsBehindAMoverAreTheSameAfterwards) {
  for (int i = 0; i < 4; ++i) see({});
  const std::vector<Anchor> before = set_->read();
  View view{.radius = 35.0};
  int covered = 0;
  for (int i = 0; i < 24; ++i) {
    view.disc = {-40.0 + 16.0 * i, 120.0};
    see(view);
    const std::vector<Anchor> now = set_->read();
    for (const Anchor& each : now) {
      if (!each.isAlive() || glm::distance(glm::dvec2(each.px), view.disc) > 30.0) continue;
      covered += each.isCovered() ? 1 : 0;
      ASSERT_TRUE(each.isCovered() || (each.state & Anchor::kMover) != 0) << i;
    }
  }
  EXPECT_GT(covered, 500);
  see({});
  see({});
  const std::vector<Anchor> after = set_->read();
  EXPECT_LT(births(after), 5) << "the wall needs none";
  int same = 0;
  int all = 0;
  for (std::size_t slot = 0; slot < before.size(); ++slot) {
    if (!before[slot].isStaying()) continue;
    ++all;
    const bool isSame = after[slot].isStaying() && after[slot].seed == before[slot].seed;
    same += isSame ? 1 : 0;
  }
  EXPECT_GT(same, all * 97 / 100) << "of " << all;
}

TEST_F(MotionLayersTest, AnchorsAreRememberedForSoLongOnly) {
  hold_.memory = std::chrono::milliseconds(200);
  for (int i = 0; i < 4; ++i) see({});
  const View view{.disc = {160.0, 120.0}, .radius = 35.0};
  const auto covered = [&] {
    const std::vector<Anchor> now = set_->read();
    return std::ranges::count_if(now, [](const Anchor& each) { return each.isCovered(); });
  };
  for (int i = 0; i < 4; ++i) see(view);
  EXPECT_GT(covered(), 50);
  for (int i = 0; i < 5; ++i) see(view);
  EXPECT_LT(covered(), 5);
}

}  // namespace
}  // namespace pleinair::marks
