// Accents: strokes on what is as narrow as they are, and the anchors that they grow from.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/gpu/marks/stroke_fixture.h"

namespace pleinair::marks {
namespace {

constexpr double kWire = 0.1;
constexpr double kWall = 0.7;

/// A dark wire of 4 px that waves over a bright wall.
double distanceToWire(glm::dvec2 px) {
  return std::abs(px.y - 64.0 - 10.0 * std::sin(0.05 * px.x));
}
const auto kWavingWire = [](glm::dvec2 px) { return distanceToWire(px) < 2.0 ? kWire : kWall; };

bool isDark(glm::vec3 colour) {
  return colour.g < 0.4F;
}

class StrokeAccents : public StrokeTest {
 protected:
  static StrokeRule ruleWith(float besidePx, float wanderRad = 0.05F) {
    return {.segmentPx = 4.0F, .wanderRad = wanderRad, .besidePx = besidePx, .widthPx = 4.0F};
  }
  static constexpr float kBeside = 4.5F;

  /// The number of strokes that are painted after the first dark one and are not dark.
  int brightOverDark() const {
    int over = 0;
    bool hasSeenDark = false;
    for (const StrokeInstance& each : readInstances()) {
      const bool dark = isDark(each.paint);
      hasSeenDark = hasSeenDark || dark;
      over += hasSeenDark && !dark ? 1 : 0;
    }
    return over;
  }

  /// How many strokes that are seen are accents; `onModels`: of those on virtual objects.
  std::ptrdiff_t accents(bool onModels = false) const {
    constexpr std::uint32_t kAccent = 0x40000000U;
    constexpr std::uint32_t kLabel = 8191U;
    const std::vector<StrokeSlot> strokes = readStrokes();
    return std::ranges::count_if(strokes, [&](const StrokeSlot& each) {
      return each.seen > 0.0F && (each.state & kAccent) != 0U &&
             (!onModels || (each.state & kLabel) == 1U);
    });
  }

  /// The mean length of strokes that are dark, in segments.
  double darkLength() const {
    double sum = 0.0;
    int number = 0;
    for (const StrokeSlot& each : readStrokes()) {
      if (each.seen <= 0.0F || !isDark(each.colour)) continue;
      sum += each.lengths.x + each.lengths.y;
      ++number;
    }
    EXPECT_GT(number, 10);
    return sum / std::max(number, 1);
  }

  double shareOnWire() const {
    const auto anchors = alive();
    const auto on = std::ranges::count_if(
        anchors, [](const auto& each) { return distanceToWire(glm::dvec2(each.second.px)) < 2.0; });
    return static_cast<double>(on) / static_cast<double>(anchors.size());
  }
};

TEST_F(StrokeAccents, LieOverTheOthers) {
  advance(greyPicture(kSize, kWavingWire), ruleWith(kBeside));
  // Strokes of the wire's border are as dark, and have the wall on one side only.
  const int over = brightOverDark();
  EXPECT_GT(accents(), 10);
  beginAnew();
  advance(greyPicture(kSize, kWavingWire), ruleWith(0.0F));
  EXPECT_GT(brightOverDark(), 200) << "the control";
  EXPECT_LT(over, brightOverDark() / 4);
}

TEST_F(StrokeAccents, StayOnesWhileTheirContrastFades) {
  // Differences of luma: of colour, they are 1.7 times as much.
  const auto wire = [](double contrast) {
    return greyPicture(kSize, [contrast](glm::dvec2 px) {
      return distanceToWire(px) < 2.0 ? kWall - contrast : kWall;
    });
  };
  advance(wire(0.055), ruleWith(kBeside));
  EXPECT_EQ(accents(), 0);
  beginAnew();
  advance(wire(0.3), ruleWith(kBeside));
  const auto first = accents();
  EXPECT_GT(first, 10);
  advance(wire(0.055), ruleWith(kBeside));
  EXPECT_GT(accents(), first / 2);
  advance(wire(0.004), ruleWith(kBeside));
  EXPECT_EQ(accents(), 0);
  advance(wire(0.1), ruleWith(kBeside));
  EXPECT_EQ(accents(), 0) << "strokes that exist need more";
  advance(wire(0.3), ruleWith(kBeside));
  EXPECT_GT(accents(), first / 2);
}

TEST_F(StrokeAccents, FollowWhatIsNarrow) {
  constexpr float kStray = 0.3F;  // rad
  advance(greyPicture(kSize, kWavingWire), ruleWith(kBeside, kStray));
  const double length = darkLength();
  beginAnew();
  advance(greyPicture(kSize, kWavingWire), ruleWith(0.0F, kStray));
  EXPECT_GT(length, 1.1 * darkLength());
}

TEST_F(StrokeAccents, AreBornOnWhatIsNarrow) {
  beginAnew({.density = {.cellPixels = 12}, .accentPixels = kBeside});
  advance(greyPicture(kSize, kWavingWire), ruleWith(kBeside));
  const double share = shareOnWire();
  beginAnew();
  advance(greyPicture(kSize, kWavingWire), ruleWith(kBeside));
  EXPECT_GT(share, 2.0 * shareOnWire());
}

TEST_F(StrokeAccents, AnEdgeIsNone) {
  const auto edge = [](glm::dvec2 px) { return px.y < 64.0 ? kWire : kWall; };
  beginAnew({.density = {.cellPixels = 12}, .accentPixels = kBeside});
  advance(greyPicture(kSize, edge), ruleWith(kBeside));
  EXPECT_EQ(accents(), 0);
}

TEST_F(StrokeAccents, AreNoneWhereNothingIsLookedAt) {
  advance(greyPicture(kSize, kWavingWire), ruleWith(0.0F));
  EXPECT_EQ(accents(), 0);
}

TEST_F(StrokeAccents, AreNotOnModels) {
  advance(greyPicture(kSize, kWavingWire), ruleWith(kBeside));
  EXPECT_GT(accents(), 10);
  // Slots that accents have left are given to strokes of the model that comes.
  useObject([](glm::vec2) { return true; });
  for (int i = 0; i < 40; ++i) advance(greyPicture(kSize, kWavingWire), ruleWith(kBeside));
  EXPECT_EQ(accents(true), 0);
}

class DetailDensity : public StrokeTest {
 protected:
  /// Anchors in the left half, which is full of detail, over those in the right one, which is
  /// plain.
  double leftOverRight(float factor) {
    beginAnew({.density = {.cellPixels = 12, .detailFactor = factor, .detailRange = {0.3F, 0.6F}}});
    const hal::Image picture = greyPicture(kSize, [](glm::dvec2 px) {
      return px.x < 128.0 ? 0.5 + 0.4 * std::sin(px.x) * std::sin(1.3 * px.y) : 0.5;
    });
    const tracking::ImageMotion motion = standing();
    const gpu::Texture texture = support::textureOf(picture.view());
    const scene::ArFrame frame = frameOf(texture, motion, kStep);
    motionField_->update(frame);
    field_->update(frame, texture, *motionField_, kNoMemory);
    anchors_->advance(frame, *motionField_, {}, nullptr, &*field_);
    const auto anchors = alive();
    const auto left =
        std::ranges::count_if(anchors, [](const auto& each) { return each.second.px.x < 112.0F; });
    const auto right =
        std::ranges::count_if(anchors, [](const auto& each) { return each.second.px.x > 144.0F; });
    return static_cast<double>(left) / static_cast<double>(std::max<std::ptrdiff_t>(right, 1));
  }
};

TEST_F(DetailDensity, HasMoreAnchorsWhereThereIsDetail) {
  EXPECT_NEAR(leftOverRight(1.0F), 1.0, 0.15);
  EXPECT_NEAR(leftOverRight(2.5F), 2.5, 0.3);
}

}  // namespace
}  // namespace pleinair::marks
