// Strokes on the patches of a model: they stay on theirs, however narrow another one is, and take
// its colours only.
#include <algorithm>
#include <cmath>
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
  advance(picture, broad(), standing(), &paint);
  EXPECT_EQ(across(), 0);
  int onBelt = 0;
  for (const StrokeTips& each : tips(broad().segmentPx)) {
    if (std::min(std::abs(each.anchor.y - top_), std::abs(each.anchor.y - bottom_)) < 1.0F) continue;
    const bool isOn = isBelt(each.anchor);
    onBelt += isOn ? 1 : 0;
    EXPECT_EQ(each.colour.r > each.colour.b, isOn) << each.anchor.y;
    EXPECT_GT(std::abs(each.colour.r - each.colour.b), 0.7F) << "no mixture, " << each.anchor.y;
  }
  EXPECT_GT(onBelt, 20);
}

/// A stroke keeps the label of its birth, also where its surface is seen under another pixel.
TEST_F(StrokePatches, LabelsLastForLife) {
  const hal::Image picture = greyPicture(kSize, upright);
  useBelt(56.0F, 70.0F);
  advance(picture, broad());
  const std::vector<StrokeSlot> first = readStrokes();
  for (int i = 0; i < 5; ++i) advance(picture, broad());
  const std::vector<StrokeSlot> then = readStrokes();
  const auto labelOf = [](const StrokeSlot& stroke) { return stroke.state & 4095U; };
  int compared = 0;
  for (const auto& [slot, anchor] : alive()) {
    if (anchor.ageSeconds < 0.1F) continue;
    EXPECT_EQ(labelOf(first[slot]), labelOf(then[slot]));
    EXPECT_EQ(labelOf(then[slot]), isBelt(anchor.px) ? kBelt : kBody) << anchor.px.y;
    ++compared;
  }
  EXPECT_GT(compared, 100);
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

}  // namespace
}  // namespace pleinair::marks
