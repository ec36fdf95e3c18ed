// The quads that strokes are drawn with: as few as their curvature allows, compared with splines of
// the CPU.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>
#include <gmock/gmock.h>

#include "tests/gpu/painterly/strip_fixture.h"
#include "tests/oracles/stroke_oracle.h"

namespace pleinair::styles {
namespace {

std::vector<glm::dvec2> pointsOf(const LaidStroke& stroke) {
  return {stroke.points.begin(), stroke.points.end()};
}

/// A part of a circle, of `turn` rad in all.
LaidStroke arc(glm::vec2 from, float lengthPx, float turn) {
  LaidStroke stroke;
  glm::vec2 at = from;
  for (std::size_t i = 0; i < 8; ++i) {
    stroke.points.at(i) = at;
    const float heading = turn * static_cast<float>(i) / 7.0F;
    at += lengthPx / 7.0F * glm::vec2(std::cos(heading), std::sin(heading));
  }
  return stroke;
}

/// A strip's middle line, without the vertices that stand twice.
std::vector<glm::dvec2> middlesOf(std::span<const StripVertex> strip) {
  std::vector<glm::dvec2> middles;
  for (std::size_t i = 1; i + 2 < strip.size(); i += 2) {
    middles.emplace_back(0.5F * (strip[i].at + strip[i + 1].at));
  }
  return middles;
}

double distanceTo(glm::dvec2 point, const std::vector<glm::dvec2>& line) {
  double least = 1e9;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const glm::dvec2 along = line[i + 1] - line[i];
    const double t = std::clamp(
        glm::dot(point - line[i], along) / std::max(glm::dot(along, along), 1e-9), 0.0, 1.0);
    least = std::min(least, glm::distance(point, line[i] + t * along));
  }
  return least;
}

/// How far the spline, and both sides of the stroke, lie off the quads at most.
double furthestOff(const LaidStroke& stroke, std::span<const StripVertex> strip) {
  const std::vector<glm::dvec2> points = pointsOf(stroke);
  std::array<std::vector<glm::dvec2>, 2> sides;
  for (std::size_t i = 1; i + 1 < strip.size(); ++i) sides.at(i % 2).emplace_back(strip[i].at);
  double worst = 0.0;
  for (double s = 0.5; s <= 8.5; s += 0.05) {
    const glm::dvec2 at = oracles::splinePlace(points, s);
    worst = std::max(worst, distanceTo(at, middlesOf(strip)));
    const glm::dvec2 along = glm::normalize(oracles::splinePlace(points, s + 1e-3) -
                                            oracles::splinePlace(points, s - 1e-3));
    const glm::dvec2 across = double{drawnHalfWidth(stroke)} * glm::dvec2(-along.y, along.x);
    worst = std::max(
        {worst, std::min(distanceTo(at + across, sides[0]), distanceTo(at + across, sides[1]))});
  }
  return worst;
}

class StripsTest : public StripTest {
 protected:
  std::vector<StripVertex> only(const LaidStroke& stroke) {
    lay({stroke});
    return vertices();
  }
};

TEST_F(StripsTest, AStraightStrokeIsOneQuad) {
  const LaidStroke stroke = straightStroke({20.0F, 30.0F}, {60.0F, 60.0F});  // 50 px long
  const std::vector<StripVertex> strip = only(stroke);
  ASSERT_EQ(strip.size(), 6U) << "four corners, the first and the last twice";
  const glm::vec2 along(0.8F, 0.6F);
  const glm::vec2 across(-0.6F, 0.8F);
  const glm::vec2 start = glm::vec2(20.0F, 30.0F) - 0.6F * 4.0F * along;
  const glm::vec2 end = glm::vec2(60.0F, 60.0F) + 0.6F * 4.0F * along;
  const glm::vec2 aside = drawnHalfWidth(stroke) * across;
  const std::array<glm::vec2, 6> corners{start - aside, start - aside, start + aside,
                                         end - aside,   end + aside,   end + aside};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_LT(glm::distance(strip[i].at, corners.at(i)), 0.01F) << i;
    EXPECT_NEAR(strip[i].brush[0] / 65535.0, i < 3 ? 0.0 : 1.0, 1e-4);
    EXPECT_NEAR(strip[i].along[0] / 32767.0, 0.8, 1e-3);
    EXPECT_NEAR(strip[i].along[1] / 32767.0, 0.6, 1e-3);
  }
}

TEST_F(StripsTest, QuadsAreAsManyAsAStrokeBends) {
  std::vector<std::size_t> counts;
  for (const float turn : {0.0F, 0.1F, 0.4F, 1.0F, 2.0F, 3.0F}) {
    const LaidStroke stroke = arc({30.0F, 30.0F}, 40.0F, turn);
    const std::vector<StripVertex> strip = only(stroke);
    counts.push_back(strip.size() / 2 - 2);
    EXPECT_LT(furthestOff(stroke, strip), 0.45) << turn;
  }
  EXPECT_EQ(counts.front(), 1U);
  EXPECT_TRUE(std::ranges::is_sorted(counts)) << testing::PrintToString(counts);
  EXPECT_GT(counts[3], 2U);
  EXPECT_LE(counts.back(), 7U);
  EXPECT_GT(furthestOff(arc({30.0F, 30.0F}, 40.0F, 1.0F),
                        only(straightStroke({30.0F, 30.0F}, {66.0F, 45.0F}))),
            1.0)
      << "the measure can fail";
}

/// Quads bend only where the spline has its knots, so that what is left of very bent strokes is
/// more.
TEST_F(StripsTest, StaysOnTheSplineWhateverItDoes) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> part(-1.0F, 1.0F);
  std::vector<LaidStroke> strokes;
  for (int i = 0; i < 300; ++i) {
    LaidStroke stroke;
    glm::vec2 at(100.0F, 100.0F);
    float heading = 3.0F * part(random);
    float bend = 0.12F * part(random);
    for (glm::vec2& point : stroke.points) {
      point = at;
      at += 6.0F * glm::vec2(std::cos(heading), std::sin(heading));
      heading += bend;
      bend += 0.05F * part(random);
    }
    stroke.halfWidth = 4.0F + 2.0F * part(random);
    strokes.push_back(stroke);
  }
  lay(strokes);
  const std::vector<StripVertex> all = vertices();
  const auto plans = support::readBuffer<std::array<std::uint32_t, 2>>(strips_.plans);
  std::size_t first = 0;
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    ASSERT_EQ(plans[i][1], first) << "in the order of painting, without a gap";
    const std::size_t end = i + 1 < strokes.size() ? plans[i + 1][1] : all.size();
    EXPECT_LT(furthestOff(strokes[i], std::span(all).subspan(first, end - first)), 0.6) << i;
    first = end;
  }
  const double quads = (static_cast<double>(all.size()) / 300.0 - 4.0) / 2.0;
  RecordProperty("quads_a_stroke", std::to_string(quads));
  EXPECT_LT(quads, 4.0);
  EXPECT_GT(quads, 1.2);
}

/// There is room for two quads a slot. Where all slots have strokes that bend, all bend less often.
TEST_F(StripsTest, BendsLessOftenWhereThereIsNotRoomForAll) {
  constexpr std::size_t kStrokes = 300;
  std::vector<LaidStroke> strokes;
  for (std::size_t i = 0; i < kStrokes; ++i) {
    const float x = 50.0F + 20.0F * static_cast<float>(i % 20);
    strokes.push_back(arc({x, 2.0F * static_cast<float>(i)}, 90.0F, 6.0F));
  }
  const std::size_t each = only(strokes[0]).size();
  ASSERT_GT(each, 14U) << "so that there is something to leave out";
  strips_ = {};
  lay(strokes);
  EXPECT_EQ(vertices().size(), each * kStrokes) << "the control: there is room for all";

  strips_ = {};
  layInSlots(kStrokes, strokes);
  const std::vector<StripVertex> strips = vertices();
  ASSERT_EQ(strips.size(), 8U * kStrokes);
  for (std::size_t i = 0; i < kStrokes; ++i) {
    const std::vector<glm::dvec2> middles =
        middlesOf(std::span<const StripVertex>(strips).subspan(8 * i, 8));
    ASSERT_EQ(middles.size(), 3U);
    const double off = distanceTo(oracles::splinePlace(pointsOf(strokes[i]), 4.5), middles);
    EXPECT_LT(off, 20.0) << "of a stroke of 90 px that nearly closes";
    EXPECT_LT(glm::distance(middles[0], glm::dvec2(strokes[i].points[0])), 5.0);
  }
}

/// Where along the brush a place is does not depend on how many quads there are.
TEST_F(StripsTest, ABrushLiesEvenlyAlong) {
  const LaidStroke stroke = arc({30.0F, 30.0F}, 40.0F, 2.0F);
  for (const StrokeQuads quads : {StrokeQuads::kCurvature, StrokeQuads::kThesis}) {
    lay({stroke}, quads);
    const std::vector<StripVertex> strip = vertices();
    const std::vector<glm::dvec2> middles = middlesOf(strip);
    double way = 0.0;
    double whole = 0.0;
    for (std::size_t i = 1; i < middles.size(); ++i)
      whole += glm::distance(middles[i], middles[i - 1]);
    for (std::size_t i = 1; i < middles.size(); ++i) {
      way += glm::distance(middles[i], middles[i - 1]);
      EXPECT_NEAR(strip[2 * i + 1].brush[0] / 65535.0, way / whole, 0.025) << i;
    }
  }
}

TEST_F(StripsTest, TheThesissQuadsAreItsSamples) {
  const LaidStroke stroke = arc({30.0F, 30.0F}, 40.0F, 2.0F);
  lay({stroke, straightStroke({0.0F, 0.0F}, {30.0F, 0.0F})}, StrokeQuads::kThesis);
  const std::vector<StripVertex> all = vertices();
  ASSERT_EQ(all.size(), 2U * (2 * 36 + 4)) << "straight ones, too";
  const std::vector<glm::dvec2> middles = middlesOf(std::span(all).first(2 * 36 + 4));
  const std::vector<glm::dvec2> samples = oracles::thesisSplineSamples(pointsOf(stroke));
  ASSERT_EQ(middles.size(), samples.size());
  for (std::size_t i = 1; i + 1 < samples.size(); ++i) {
    EXPECT_LT(glm::distance(middles[i], samples[i]), 0.01) << i;
  }
}

TEST_F(StripsTest, BrushesVariantsAndObjectsAreTold) {
  LaidStroke plain = straightStroke({0.0F, 0.0F}, {30.0F, 0.0F});
  plain.variant = 2.0F;
  plain.label = 4095.0F;
  LaidStroke mirrored = plain;
  mirrored.variant = 6.0F;
  lay({plain, mirrored});
  const std::vector<StripVertex> all = vertices();
  ASSERT_EQ(all.size(), 12U);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(all[i].label, 4095U);
    const double row = 4.0 * all[i].brush[1] / 65535.0;
    EXPECT_GT(row, 2.0);
    EXPECT_LT(row, 3.0);
    EXPECT_NEAR(4.0 * all[i + 6].brush[1] / 65535.0, 5.0 - row, 1e-3) << "the other way round";
  }
  const float drawn = drawnHalfWidth(plain) / plain.halfWidth;
  EXPECT_NEAR(glm::unpackHalf1x16(all[0].shape[1]), drawn, 2e-3);
  EXPECT_NEAR(glm::unpackHalf1x16(all[6].shape[1]), -drawn, 2e-3);
}

/// Which command draws a stroke beside one of this label, which the third has if it is carried.
class StripClippingTest : public StripTest {
 protected:
  static constexpr float kMover = 4093.0F;  // shaders/stroke_label.glsl
  static constexpr float kSegment = 4096.0F;

  enum class Drawn { kPlain, kClipped, kWrong };
  Drawn drawnWith(const StripClipping& clipping, float label = 0.0F,
                  StrokeQuads quads = StrokeQuads::kCurvature) {
    LaidStroke other = straightStroke({10.0F, 30.0F}, {60.0F, 30.0F});
    other.label = label;
    lay({straightStroke({10.0F, 10.0F}, {60.0F, 10.0F}), other}, quads, clipping);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    const auto commands = support::readBuffer<std::uint32_t>(strips_.commands);
    const bool isCarried = label != 0.0F && label < kSegment;
    EXPECT_EQ(commands[8] > 0, isCarried);
    if (commands[0] > 0 && commands[4] == 0) return Drawn::kPlain;
    if (commands[4] > 0 && commands[0] == 0) return Drawn::kClipped;
    return Drawn::kWrong;
  }
  /// `blocks`: how many are busy.
  StripClipping byMovers(std::uint32_t blocks) {
    const std::array<std::uint32_t, 4> words{7, 7, 7, blocks};
    words_ = gpu::Buffer::of(std::span<const std::uint32_t>(words), gpu::BufferUsage::kDynamic);
    return {.clips = true, .onlyMovers = marks::BusyBlocks{.words = &words_, .grid = {1, 1}}};
  }

 private:
  gpu::Buffer words_;
};

TEST_F(StripClippingTest, IsPlainWhereThereIsNothingToClipBy) {
  EXPECT_EQ(drawnWith({}), Drawn::kPlain);
  EXPECT_EQ(drawnWith({.clips = true}), Drawn::kClipped);
  EXPECT_EQ(drawnWith(byMovers(0)), Drawn::kPlain);
  EXPECT_EQ(drawnWith(byMovers(1)), Drawn::kClipped);
}

TEST_F(StripClippingTest, ClipsWhatAMoverLeavesBehind) {
  EXPECT_EQ(drawnWith(byMovers(0), kMover), Drawn::kClipped);
  EXPECT_EQ(drawnWith(byMovers(0), 17.0F), Drawn::kClipped) << "a patch's";
  EXPECT_EQ(drawnWith(byMovers(0), kSegment), Drawn::kPlain);
  EXPECT_EQ(drawnWith(byMovers(0), kMover, StrokeQuads::kThesis), Drawn::kClipped);
  EXPECT_EQ(drawnWith(byMovers(0), 0.0F, StrokeQuads::kThesis), Drawn::kPlain);
}

TEST_F(StripClippingTest, CarriedStrokesComeLast) {
  LaidStroke carried = arc({20.0F, 20.0F}, 60.0F, 1.5F);
  LaidStroke other = straightStroke({10.0F, 30.0F}, {60.0F, 30.0F});
  lay({carried, other, carried});
  const std::vector<StripVertex> inOrder = vertices();
  carried.label = kMover;
  lay({carried, other, carried}, StrokeQuads::kCurvature, {.clips = true});
  const std::vector<StripVertex> apart = vertices();
  const auto commands = support::readBuffer<std::uint32_t>(strips_.commands);
  ASSERT_EQ(apart.size(), inOrder.size());
  const std::size_t others = commands[4];
  const std::size_t each = commands[8] / 2;
  for (std::size_t i = 0; i < others; ++i) EXPECT_EQ(apart[i].at, inOrder[each + i].at);
  for (std::size_t i = 0; i < each; ++i) {
    EXPECT_EQ(apart[others + i].at, inOrder[i].at);
    EXPECT_EQ(apart[others + each + i].at, inOrder[each + others + i].at);
  }
}

TEST_F(StripClippingTest, ChangesNoVertex) {
  const std::vector<LaidStroke> strokes{arc({20.0F, 20.0F}, 60.0F, 1.5F)};
  lay(strokes);
  const std::vector<StripVertex> plain = vertices();
  std::vector<LaidStroke> carried = strokes;
  carried[0].label = kMover;
  lay(carried, StrokeQuads::kCurvature, {.clips = true});
  const auto commands = support::readBuffer<std::uint32_t>(strips_.commands);
  EXPECT_EQ(commands[8], plain.size());
  const auto clipped = support::readBuffer<StripVertex>(strips_.vertices);
  for (std::size_t i = 0; i < plain.size(); ++i) EXPECT_EQ(clipped[i].at, plain[i].at);
}

}  // namespace
}  // namespace pleinair::styles
