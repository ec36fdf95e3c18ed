// Strokes on the patches of a model: they stay on theirs, however narrow another one is, and take
// its colours only.
#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "tests/gpu/marks/stroke_fixture.h"

namespace pleinair::marks {
namespace {

constexpr std::uint32_t kBody = 1;
constexpr std::uint32_t kBelt = 2;

/// Stripes, so that strokes are upright.
double upright(glm::dvec2 px) {
  return 0.5 + 0.3 * std::sin(0.9 * px.x);
}

/// A body that fills the picture, with something narrow before it, of another colour.
class StrokePatches : public StrokeTest {
 protected:
  static StrokeRule broad() {
    StrokeRule rule;
    rule.segmentPx = 16.0F;
    rule.colourThreshold = 5.0F;  // it is not the colour that ends them
    rule.minSteps = 0.0F;
    rule.wanderRad = 0.0F;
    rule.widthPx = 1.0F;  // the least that is painted is a dab as wide
    return rule;
  }
  /// Level, between these rows.
  void useBelt(float top, float bottom) {
    top_ = top;
    bottom_ = bottom;
    usePatches([=](glm::vec2 px) { return px.y >= top && px.y < bottom ? kBelt : kBody; });
  }
  bool isBelt(glm::vec2 px) const { return px.y >= top_ && px.y < bottom_; }
  /// Red on the belt, else blue.
  hal::Image colours() const {
    hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = kSize});
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        auto* p = image.row(0, y).data() + std::ptrdiff_t{x} * 4;
        const bool isOn = isBelt({static_cast<float>(x), static_cast<float>(y)});
        p[0] = isOn ? 220 : 20;
        p[1] = 20;
        p[2] = isOn ? 20 : 220;
        p[3] = 255;
      }
    }
    return image;
  }
  static hal::Image purple() {
    hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = kSize});
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        auto* p = image.row(0, y).data() + std::ptrdiff_t{x} * 4;
        p[0] = p[2] = 120;
        p[1] = 20;
        p[3] = 255;
      }
    }
    return image;
  }
  /// How many strokes have points more than a pixel above the belt and as far below it.
  int across() const {
    int count = 0;
    for (const StrokeInstance& each : readInstances()) {
      const auto [low, high] = std::ranges::minmax(each.points, {}, &glm::vec2::y);
      count += low.y < top_ - 1.0F && high.y > bottom_ + 1.0F ? 1 : 0;
    }
    return count;
  }

  float top_ = 0.0F;
  float bottom_ = 0.0F;
};

/// A wire of two px is narrower than an eighth of a segment.
TEST_F(StrokePatches, NoStrokeJumpsAWire) {
  const hal::Image picture = greyPicture(kSize, upright);
  useBelt(60.0F, 62.0F);
  advance(picture, broad());
  EXPECT_EQ(across(), 0);
  beginAnew();
  usePatches([](glm::vec2) { return kBody; });
  advance(picture, broad());
  EXPECT_GT(across(), 20) << "the control: a single patch";
}

/// Nor does one run over a belt: it is narrower than a stroke is long.
TEST_F(StrokePatches, ABeltIsPaintedByItself) {
  const hal::Image picture = greyPicture(kSize, upright);
  useBelt(56.0F, 70.0F);
  const hal::Image paint = colours();
  // The reduced image shows one mixture of both, as texels that lie on both do.
  mixed_ = support::textureOf(purple().view());
  advance(picture, broad(), standing(), &paint);
  EXPECT_EQ(across(), 0);
  int onBelt = 0;
  for (const StrokeTips& each : tips(broad().segmentPx)) {
    const float away = std::min(std::abs(each.anchor.y - top_), std::abs(each.anchor.y - bottom_));
    if (away < 1.0F || away > kMixedPx - 2.0F) continue;
    const bool isOn = isBelt(each.anchor);
    onBelt += isOn ? 1 : 0;
    EXPECT_EQ(each.colour.r > each.colour.b, isOn) << each.anchor.y;
    // Both are 0.78 apart; the finer image is read between its pixels.
    EXPECT_GT(std::abs(each.colour.r - each.colour.b), 0.5F) << "a mixture at " << each.anchor.y;
  }
  EXPECT_GT(onBelt, 20);
}

/// A stroke keeps the label of its birth, also when another patch is seen at its anchor's pixel.
TEST_F(StrokePatches, LabelsLastForLife) {
  const hal::Image picture = greyPicture(kSize, upright);
  follows_ = false;
  useBelt(56.0F, 70.0F);
  advance(picture, broad());
  const std::vector<StrokeSlot> first = readStrokes();
  useBelt(60.0F, 74.0F);
  for (int i = 0; i < 5; ++i) advance(picture, broad());
  const std::vector<StrokeSlot> then = readStrokes();
  const auto labelOf = [](const StrokeSlot& stroke) { return stroke.state & 4095U; };
  int crossed = 0;
  int compared = 0;
  for (const auto& [slot, anchor] : alive()) {
    if (anchor.ageSeconds() < 0.15F || !anchor.isStaying()) continue;  // born with the first frame
    EXPECT_EQ(labelOf(first[slot]), labelOf(then[slot]));
    crossed += labelOf(then[slot]) != (isBelt(anchor.px) ? kBelt : kBody) ? 1 : 0;
    ++compared;
  }
  EXPECT_GT(compared, 100);
  EXPECT_GT(crossed, 10);
}

/// A patch without anchors gets one in each cell that it has a share of, or in one beside it, and
/// keeps it, however many anchors the other one has there.
TEST_F(StrokePatches, EachPatchOfACellHasAnAnchor) {
  const hal::Image picture = greyPicture(kSize, upright);
  follows_ = false;
  usePatches([](glm::vec2) { return kBody; });
  for (int i = 0; i < 3; ++i) advance(picture, broad());
  useBelt(60.0F, 63.0F);  // a quarter of the cells' height, which is 12
  const auto onBelt = [&] {
    std::vector<std::size_t> slots;
    for (const auto& [slot, anchor] : alive()) {
      if (anchor.isStaying() && isBelt(anchor.px)) slots.push_back(slot);
    }
    return slots;
  };
  for (int i = 0; i < 3; ++i) advance(picture, broad());
  const std::vector<std::size_t> born = onBelt();
  std::set<int> cells;
  for (const auto& [slot, anchor] : alive()) {
    if (anchor.isStaying() && isBelt(anchor.px))
      cells.insert(static_cast<int>(anchor.px.x / 12.0F));
  }
  EXPECT_FALSE(cells.empty());
  for (int cell = 0; cell < 22; ++cell) {
    EXPECT_TRUE(cells.contains(cell - 1) || cells.contains(cell) || cells.contains(cell + 1))
        << "of all that the belt crosses: " << cell;
  }
  for (int i = 0; i < 60; ++i) advance(picture, broad());
  EXPECT_EQ(onBelt(), born) << "none is removed to make room and born again";
}

/// An arm before a torso of the same patch: two planes of which the nearer one ends at a column.
TEST_F(StrokePatches, AStepOfDepthEndsAStroke) {
  const hal::Image picture =
      greyPicture(kSize, [](glm::dvec2 px) { return 0.5 + 0.3 * std::sin(0.9 * px.y); });
  usePatches([](glm::vec2) { return kBody; });
  constexpr float kEdge = 120.0F;
  const auto acrossEdge = [&](float step) {
    beginAnew();
    useDepth([=](glm::vec2 px) { return 1.0F + 0.002F * px.x + (px.x < kEdge ? 0.0F : step); });
    advance(picture, broad());
    int count = 0;
    for (const StrokeInstance& each : readInstances()) {
      const auto [low, high] = std::ranges::minmax(each.points, {}, &glm::vec2::x);
      count += low.x < kEdge - 2.0F && high.x > kEdge + 2.0F ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(acrossEdge(0.1F), 0);
  EXPECT_GT(acrossEdge(0.0F), 10) << "the control: a slope without a step";
}

/// An arm and a torso are two patches of one smooth surface: strokes go on over the joint, for a
/// short way, but not from an arm that lies before the torso.
TEST_F(StrokePatches, StrokesGoOnOverAJointAndNotOverAStep) {
  constexpr std::uint32_t kOnLimb = 1U << 29U;
  constexpr std::uint32_t kAtJoint = 1U << 30U;
  constexpr float kEdge = 120.0F;
  constexpr float kOverJoint = 16.0F;
  const hal::Image picture =
      greyPicture(kSize, [](glm::dvec2 px) { return 0.5 + 0.3 * std::sin(0.9 * px.y); });
  const auto acrossEdge = [&](std::uint32_t marks, float step) {
    beginAnew();
    usePatches(
        [=](glm::vec2 px) { return px.x < kEdge ? kBody | (marks & kAtJoint) : kBelt | marks; });
    useDepth([=](glm::vec2 px) { return 1.0F + 0.002F * px.x + (px.x < kEdge ? 0.0F : step); });
    advance(picture, broad());
    int count = 0;
    for (const StrokeTips& each : tips(broad().segmentPx)) {
      const auto [low, high] = std::minmax({each.anchor.x, each.ahead.x, each.behind.x});
      if (each.anchor.x < kEdge) {
        EXPECT_LT(high, kEdge + kOverJoint + 2.0F);
      } else {
        EXPECT_GT(low, kEdge - kOverJoint - 2.0F);
      }
      count += low < kEdge - 2.0F && high > kEdge + 2.0F ? 1 : 0;
    }
    return count;
  };
  EXPECT_GT(acrossEdge(kOnLimb | kAtJoint, 0.0F), 10);
  EXPECT_EQ(acrossEdge(kOnLimb | kAtJoint, 0.1F), 0) << "the arm is before the torso";
  EXPECT_EQ(acrossEdge(kOnLimb, 0.0F), 0) << "the control: away from a joint";
  EXPECT_EQ(acrossEdge(kAtJoint, 0.0F), 0) << "the control: a crease beside a joint";
}

/// What strokes of another patch reach needs hardly any anchors of its own.
TEST_F(StrokePatches, AJointNeedsNoAnchorsOfItsOwn) {
  constexpr std::uint32_t kAtJoint = 1U << 30U;
  const hal::Image picture = greyPicture(kSize, upright);
  follows_ = false;
  usePatches([](glm::vec2) { return kBody; });
  for (int i = 0; i < 3; ++i) advance(picture, broad());
  const auto bornOnBelt = [&](std::uint32_t marks) {
    top_ = marks == 0U ? 60.0F : 84.0F;
    bottom_ = top_ + 3.0F;
    usePatches([&](glm::vec2 px) { return isBelt(px) ? kBelt | marks : kBody; });
    for (int i = 0; i < 2; ++i) advance(picture, broad());
    int count = 0;
    for (const auto& [slot, anchor] : alive()) {
      count += isBelt(anchor.px) && anchor.ageSeconds() < 0.09F ? 1 : 0;
    }
    return count;
  };
  const int atJoint = bornOnBelt(kAtJoint);
  EXPECT_LT(atJoint, bornOnBelt(0U) / 2);
}

}  // namespace
}  // namespace pleinair::marks
