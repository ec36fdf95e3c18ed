// Real things whose models are known, and movers before them: a machine that moves with its pose is
// no mover, nor is a near one before a camera that moves; a hand before it covers its anchors.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "pipeline/marks/movers/motion_layers.h"
#include "tests/gpu/marks/anchor_life_fixture.h"

namespace pleinair::marks {
namespace {

constexpr float kMiddleY = 118.0F;
constexpr double kHalf = 36.4;  // px, of the box's front
constexpr int kHandHalfHeight = 14;

/// A wall, the box before it, and a hand before both.
struct Sight {
  double wall = 0.0;  ///< shift of the wall, px
  double box = 160.0;
  std::optional<double> hand;  ///< its right end, px; it reaches in from the left
};

hal::Image imageOf(const Sight& sight, unsigned seed) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = {320, 240}});
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 1.5);
  for (int y = 0; y < 240; ++y) {
    std::uint8_t* p = image.row(0, y).data();
    for (int x = 0; x < 320; ++x, p += 4) {
      const glm::dvec2 at(x + 0.5, y + 0.5);
      const glm::dvec2 onBox = at - glm::dvec2(sight.box, double{kMiddleY});
      const double u = at.x - sight.wall;
      glm::dvec3 colour(120.0 + 30.0 * std::sin(0.21 * u + 1.3 * std::sin(0.07 * at.y)));
      if (std::abs(onBox.x) < kHalf && std::abs(onBox.y) < kHalf) {
        colour = glm::dvec3(60.0, 110.0, 160.0) +
                 30.0 * std::sin(0.3 * onBox.x) * std::cos(0.25 * onBox.y);
      }
      if (sight.hand && at.x < *sight.hand &&
          std::abs(at.y - double{kMiddleY}) < double{kHandHalfHeight}) {
        colour = glm::dvec3(230.0, 150.0, 120.0);
      }
      const double grain = noise(random);
      for (int c = 0; c < 3; ++c) {
        p[c] = static_cast<std::uint8_t>(std::clamp(colour[c] + grain + 0.5, 0.0, 255.0));
      }
      p[3] = 255;
    }
  }
  return image;
}

class CoveredRealThings : public AnchorLife {
 protected:
  void SetUp() override {
    AnchorLife::SetUp();
    if (IsSkipped()) return;
    scene::Scene scene = boxScene();
    scene.models.front().isOccluder = true;
    useScene(scene);
    layers_.emplace(library_, kSize);
  }

  std::vector<Anchor> see(const Sight& sight, double wallStep = 0.0, bool isPoseKnown = true) {
    picture_ = support::textureOf(imageOf(sight, ++seed_).view());
    scene::PoseSet poses;
    if (isPoseKnown) poses = boxAt(sight.box);
    const tracking::ImageMotion motion =
        seed_ == 1 ? tracking::ImageMotion{} : panning(wallStep, 0.0);
    const scene::ArFrame frame = compose(*renderer_, poses, motion);
    field_->update(frame);
    layers_->update(frame, *field_);
    set_->advance(frame, *field_, {}, &*layers_);
    return set_->read();
  }

  /// The shares of cells that are movers, well inside the box's front and around it.
  struct Movers {
    double onBox = 0.0;
    double beside = 0.0;
  };
  Movers moversAround(const Sight& sight) const {
    const hal::Image labels = layers_->readMovers();
    const hal::FrameSize size = labels.view().format.size;
    glm::ivec2 onBox(0);
    glm::ivec2 beside(0);
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const glm::dvec2 px = 2.0 * (glm::dvec2(x, y) + 0.5);
        const glm::dvec2 away = glm::abs(px - glm::dvec2(sight.box, double{kMiddleY}));
        const double out = std::max(away.x, away.y) - kHalf;
        const int isMover = labels.view().planes[0].bytes[static_cast<std::size_t>(y) *
                                                              labels.view().planes[0].strideBytes +
                                                          static_cast<std::size_t>(x)] > 127
                                ? 1
                                : 0;
        if (out < -4.0) onBox += glm::ivec2(isMover, 1);
        if (out > 4.0 && out < 40.0) beside += glm::ivec2(isMover, 1);
      }
    }
    return {.onBox = static_cast<double>(onBox.x) / onBox.y,
            .beside = static_cast<double>(beside.x) / beside.y};
  }

  static bool isOnBox(const Anchor& each, const Sight& sight, double border) {
    const glm::vec2 away = glm::abs(each.px - glm::vec2(static_cast<float>(sight.box), kMiddleY));
    return std::max(away.x, away.y) < static_cast<float>(kHalf - border);
  }

  std::optional<MotionLayers> layers_;

 private:
  unsigned seed_ = 0;
};

/// The anchors of `before` on the box, well away from its outline: how many are the same ones now,
/// and how far the worst has come from where the box has taken it.
struct Kept {
  int wanted = 0;
  int kept = 0;
  double worstPx = 0.0;
};

Kept keptOf(const std::vector<Anchor>& before, const Sight& was, const std::vector<Anchor>& now,
            const Sight& is, const auto& isOnBox) {
  Kept kept;
  const glm::vec2 moved(static_cast<float>(is.box - was.box), 0.0F);
  for (std::size_t slot = 0; slot < before.size(); ++slot) {
    const Anchor& old = before[slot];
    if (!old.isStaying() || old.surface == 0 || !isOnBox(old, was, 4.0)) continue;
    ++kept.wanted;
    const Anchor& each = now[slot];
    if (!each.isAlive() || each.seed != old.seed || (each.state & Anchor::kHidden) != 0) continue;
    ++kept.kept;
    kept.worstPx =
        std::max(kept.worstPx, static_cast<double>(glm::distance(each.px, old.px + moved)));
  }
  return kept;
}

TEST_F(CoveredRealThings, AHandCoversTheirAnchorsAndLeavesThemAsTheyWere) {
  Sight sight;
  for (int i = 0; i < 8; ++i) see(sight);
  const Sight first = sight;
  const std::vector<Anchor> before = see(sight);
  int covered = 0;
  for (int i = 0; i < 40; ++i) {
    const double t = i < 20 ? i : 40 - i;
    sight.hand = 60.0 + 7.0 * t;
    for (const Anchor& each : see(sight)) {
      covered += each.isCovered() && each.surface != 0 ? 1 : 0;
      if (each.isAlive() && (each.state & Anchor::kMover) != 0) {
        ASSERT_EQ(each.surface, 0U) << "a hand is before the box, not on it";
      }
    }
  }
  sight.hand.reset();
  std::vector<Anchor> after;
  for (int i = 0; i < 10; ++i) after = see(sight);
  EXPECT_GT(covered, 500);
  const Kept kept = keptOf(before, first, after, sight, isOnBox);
  EXPECT_GT(kept.wanted, 100);
  EXPECT_GT(kept.kept, kept.wanted * 95 / 100);
  EXPECT_LT(kept.worstPx, 0.05);
}

/// A machine's arm, say, before a wall and a camera that stand.
TEST_F(CoveredRealThings, WhatMovesWithItsPoseIsNoMover) {
  Sight sight{.box = 110.0};
  for (int i = 0; i < 8; ++i) see(sight);
  const Sight first = sight;
  const std::vector<Anchor> before = see(sight);
  std::vector<Anchor> now;
  for (int i = 0; i < 30; ++i) {
    sight.box += 2.0;
    now = see(sight);
    const Movers movers = moversAround(sight);
    ASSERT_LT(movers.onBox, 0.01) << i;
    ASSERT_LT(movers.beside, 0.02) << i;
  }
  const Kept kept = keptOf(before, first, now, sight, isOnBox);
  EXPECT_GT(kept.wanted, 100);
  EXPECT_GT(kept.kept, kept.wanted * 95 / 100);
  EXPECT_LT(kept.worstPx, 0.05);
}

/// A camera that moves past a near thing, before a wall that most of the image shows.
TEST_F(CoveredRealThings, ParallaxIsNoMover) {
  Sight sight{.box = 210.0};
  for (int i = 0; i < 8; ++i) see(sight);
  const Sight first = sight;
  const std::vector<Anchor> before = see(sight);
  std::vector<Anchor> now;
  for (int i = 0; i < 25; ++i) {
    sight.wall -= 1.0;
    sight.box -= 3.0;
    now = see(sight, -1.0);
    const Movers movers = moversAround(sight);
    ASSERT_LT(movers.onBox, 0.01) << i;
    ASSERT_LT(movers.beside, 0.02) << i;
  }
  const Kept kept = keptOf(before, first, now, sight, isOnBox);
  EXPECT_GT(kept.wanted, 100);
  EXPECT_GT(kept.kept, kept.wanted * 95 / 100);
  EXPECT_LT(kept.worstPx, 0.05);
}

/// A wall whose pose is known goes twice as fast as most of the image is said to.
TEST_F(CoveredRealThings, AHandBeforeAPlaneLeavesItsAnchorsWithThePlane) {
  scene::Scene scene;
  scene.planes.push_back({.name = "wall", .sizeMetres = {2.0, 2.0}});
  useScene(scene);
  layers_.emplace(library_, kSize);
  // The plane is where the box would be, 0.5 m away.
  Sight sight{.box = 160.0};
  const auto step = [&](double shift) {
    sight.wall += shift;
    sight.box += shift;
    return see(sight, 0.5 * shift);
  };
  for (int i = 0; i < 6; ++i) step(0.0);
  const std::vector<Anchor> before = step(-1.0);
  const double from = sight.wall;
  int covered = 0;
  std::vector<Anchor> now;
  for (int i = 0; i < 40; ++i) {
    sight.hand.reset();
    if (i < 30) sight.hand = 60.0 + 7.0 * std::min(i, 30 - i);
    now = step(i % 20 < 10 ? -1.0 : 1.0);
    for (const Anchor& each : now) covered += each.isCovered() ? 1 : 0;
  }
  EXPECT_GT(covered, 500);
  int wanted = 0;
  int kept = 0;
  double worst = 0.0;
  const glm::vec2 moved(static_cast<float>(sight.wall - from), 0.0F);
  for (std::size_t slot = 0; slot < before.size(); ++slot) {
    const glm::vec2 was = before[slot].px;
    // Beside the image's border and the pattern of the box, which ends with the image.
    if (!before[slot].isStaying() || !isWithin(was, 20.0F) || was.x > 200.0F) continue;
    ++wanted;
    if (!now[slot].isStaying() || now[slot].seed != before[slot].seed) continue;
    ++kept;
    worst = std::max(worst, static_cast<double>(glm::distance(now[slot].px, was + moved)));
  }
  EXPECT_GT(wanted, 500);
  EXPECT_GT(kept, wanted * 9 / 10);
  EXPECT_LT(worst, 0.05);
}

/// The control: without its pose, the same thing is a mover.
TEST_F(CoveredRealThings, WithoutAPoseTheyAreMovers) {
  Sight sight{.box = 110.0};
  for (int i = 0; i < 8; ++i) see(sight, 0.0, false);
  double most = 0.0;
  for (int i = 0; i < 10; ++i) {
    sight.box += 2.0;
    see(sight, 0.0, false);
    most = std::max(most, moversAround(sight).onBox);
  }
  EXPECT_GT(most, 0.2);
}

TEST_F(CoveredRealThings, AHandBeforeAMovingThingIsAMover) {
  Sight sight{.box = 110.0};
  for (int i = 0; i < 8; ++i) see(sight);
  int onHand = 0;
  int elsewhere = 0;
  for (int i = 0; i < 20; ++i) {
    sight.box += 1.0;
    sight.hand = 40.0 + 6.0 * i;
    for (const Anchor& each : see(sight)) {
      if (!each.isStaying() || (each.state & Anchor::kMover) == 0) continue;
      const bool isHand =
          each.px.x < static_cast<float>(*sight.hand) + 6.0F &&
          std::abs(each.px.y - kMiddleY) < static_cast<float>(kHandHalfHeight) + 4.0F;
      (isHand ? onHand : elsewhere) += 1;
    }
  }
  EXPECT_GT(onHand, 300);
  EXPECT_LT(elsewhere, onHand / 20);
}

}  // namespace
}  // namespace pleinair::marks
