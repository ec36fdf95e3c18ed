// Strokes behind a mover and beside it: they stay as they are, and are drawn, until it has passed.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "tests/gpu/marks/stroke_fixture.h"

namespace pleinair::marks {
namespace {

constexpr glm::dvec2 kDisc{128.0, 64.0};
constexpr double kRadius = 34.0;

double wall(glm::dvec2 px) {
  return 0.3 + 0.1 * std::sin(0.6 * px.x);
}
double wallAndDisc(glm::dvec2 px) {
  return glm::distance(px, kDisc) < kRadius ? 0.8 + 0.15 * std::sin(0.6 * px.y) : wall(px);
}

/// Whether the two are equal bit for bit.
bool isSameStroke(const StrokeSlot& a, const StrokeSlot& b) {
  return std::memcmp(&a, &b, sizeof(StrokeSlot)) == 0;
}
bool isSamePaint(const StrokeInstance& a, const StrokeInstance& b) {
  return a.points == b.points && a.paint == b.paint && a.halfWidth == b.halfWidth;
}

class StrokesAtMovers : public StrokeTest {
 protected:
  void SetUp() override {
    StrokeTest::SetUp();
    if (IsSkipped()) return;
    layers_.emplace(library_, kSize);
  }
  /// Noise differs from frame to frame, so that strokes change that are not held.
  void see(const std::function<double(glm::dvec2)>& luma, int frames = 1) {
    for (int i = 0; i < frames; ++i) advance(greyPicture(kSize, luma, 3.0, ++seed_), rule_);
  }

  StrokeRule rule_;

 private:
  unsigned seed_ = 0;
};

TEST_F(StrokesAtMovers, StrokesBehindAMoverAndBesideItStayAsTheyAre) {
  see(wall, 12);
  const std::vector<Anchor> anchorsBefore = anchors_->read();
  const std::vector<StrokeSlot> before = readStrokes();
  int behind = 0;
  int beside = 0;
  int far = 0;
  int changed = 0;
  for (int frame = 0; frame < 8; ++frame) {
    see(wallAndDisc);
    const std::vector<Anchor> anchors = anchors_->read();
    const std::vector<StrokeSlot> now = readStrokes();
    for (std::size_t slot = 0; slot < now.size(); ++slot) {
      const Anchor& anchor = anchors[slot];
      const bool isSameAnchor = anchorsBefore[slot].isStaying() && anchor.isAlive() &&
                                anchor.seed == anchorsBefore[slot].seed;
      if (!isSameAnchor || anchorsBefore[slot].fade < 1.0F) continue;
      const double away = glm::distance(glm::dvec2(anchor.px), kDisc) - kRadius;
      if (anchor.isCovered()) {
        ++behind;
        EXPECT_TRUE(isSameStroke(now[slot], before[slot])) << away;
      } else if (anchor.isStaying() && away > 0.0 && away < 3.0) {
        ++beside;
        EXPECT_TRUE(isSameStroke(now[slot], before[slot])) << away;
      } else if (away > 50.0) {
        ++far;
        changed += isSameStroke(now[slot], before[slot]) ? 0 : 1;
      }
    }
  }
  EXPECT_GT(behind, 200);
  EXPECT_GT(beside, 20);
  EXPECT_GT(changed, far / 2) << "the control: noise changes strokes far away";
}

TEST_F(StrokesAtMovers, StrokesBehindAMoverAreDrawnAsBefore) {
  see(wall, 12);
  const std::vector<StrokeInstance> before = readInstances();
  see(wallAndDisc, 8);
  const std::vector<StrokeInstance> now = readInstances();
  int behind = 0;
  for (const StrokeInstance& was : before) {
    // The anchor is within 16 px of the middle: half of what one arm can be longer than the other.
    const glm::dvec2 middle = 0.5 * glm::dvec2(was.points[3] + was.points[4]);
    const bool isBehind = glm::distance(middle, kDisc) < kRadius - 18.0;
    if (!isBehind) continue;
    ++behind;
    EXPECT_TRUE(std::ranges::any_of(
        now, [&](const StrokeInstance& each) { return isSamePaint(each, was); }))
        << was.points[0].x << "," << was.points[0].y;
  }
  EXPECT_GT(behind, 8);
}

/// What it uncovers was never seen before, so that marks which it leaves there are no worse than
/// any.
TEST_F(StrokesAtMovers, WhatAMoverLeavesBehindIsNoLongerDrawnOnIt) {
  constexpr std::uint32_t kLabelMask = 0x1FFF;  // shaders/stroke.glsl
  constexpr std::uint32_t kFirstMover = 4093;   // scene/render/shaders/surface_form.glsl
  constexpr std::uint32_t kLastMover = 4095;
  int onMover = 0;
  int left = 0;
  for (int frame = 0; frame < 24; ++frame) {
    // To and fro over the place that it has uncovered.
    const double x = 90.0 + 60.0 * std::abs(std::sin(0.26 * frame));
    see([x](glm::dvec2 px) {
      return glm::distance(px, {x, 64.0}) < kRadius ? 0.8 + 0.15 * std::sin(0.6 * px.y) : wall(px);
    });
    const std::vector<Anchor> anchors = anchors_->read();
    const std::vector<StrokeSlot> strokes = readStrokes();
    for (std::size_t slot = 0; slot < strokes.size(); ++slot) {
      const Anchor& anchor = anchors[slot];
      if (!anchor.isAlive() || strokes[slot].seen <= 0.0F) continue;
      const bool isOnMover = (anchor.state & Anchor::kMover) != 0U;
      onMover += isOnMover ? 1 : 0;
      const std::uint32_t label = strokes[slot].state & kLabelMask;
      left += !isOnMover && label >= kFirstMover && label <= kLastMover ? 1 : 0;
    }
  }
  EXPECT_GT(onMover, 200);
  EXPECT_EQ(left, 0);
}

/// A disc stands there when the camera begins to look, so that it is remembered as the background;
/// then it grows, and its new rim is a mover until it has come to rest and joins the rest of the
/// disc. No stroke of the wall behind the rim may be seen on the disc meanwhile.
TEST_F(StrokesAtMovers, NoStrokeOfWhatIsCoveredIsSeenWhereAMoverJoinsTheBackground) {
  constexpr double kFirst = 16.0;
  constexpr double kLast = 40.0;
  constexpr double kInside = 5.0;  // px from the outline
  constexpr float kUnlike = 0.3F;  // of luma
  rule_.otherColour = {0.09F, 0.18F};
  int behind = 0;
  int shown = 0;
  int joined = 0;
  for (int frame = 0; frame < 50; ++frame) {
    const double radius = std::min(kFirst + 3.0 * std::max(0, frame - 4), kLast);
    const auto luma = [radius](glm::dvec2 px) {
      return glm::distance(px, kDisc) < radius ? 0.8 : wall(px);
    };
    see(luma);
    const std::vector<Anchor> anchors = anchors_->read();
    const std::vector<StrokeSlot> strokes = readStrokes();
    const std::vector<float> labels = support::readRgba32f(layers_->labels());
    const int width = layers_->labels().size().width;
    const auto isOnJoined = [&](glm::dvec2 px) {
      if (glm::distance(px, kDisc) > radius - kInside) return false;
      const glm::ivec2 cell(px / 2.0);
      return labels[4 * static_cast<std::size_t>(cell.y * width + cell.x)] < 0.5F;
    };
    for (std::size_t slot = 0; slot < strokes.size(); ++slot) {
      const StrokeSlot& stroke = strokes[slot];
      const bool isWall = stroke.colour.g < 0.8F - kUnlike;
      if (!anchors[slot].isAlive() || !anchors[slot].isCovered() || !isWall) continue;
      ++behind;
      if (stroke.seen <= 0.0F) continue;
      bool isShown = isOnJoined(anchors[slot].px);
      for (const bool isAhead : {true, false}) {
        glm::vec2 at = anchors[slot].px;
        for (std::size_t i = 0; i < 4; ++i) {
          if (static_cast<float>(i) + 0.5F > (isAhead ? stroke.lengths.x : stroke.lengths.y)) break;
          at += rule_.segmentPx * (isAhead ? stroke.ahead : stroke.behind).at(i);
          isShown = isShown || isOnJoined(at);
        }
      }
      shown += isShown ? 1 : 0;
    }
    joined += isOnJoined(kDisc + glm::dvec2(0.5 * (kFirst + kLast), 0.0)) ? 1 : 0;
  }
  EXPECT_GT(joined, 10);
  EXPECT_GT(behind, 200) << "the control: there are strokes that might be seen";
  EXPECT_LT(shown, 5);
}

}  // namespace
}  // namespace pleinair::marks
