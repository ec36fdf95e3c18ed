// Strokes: how they are grown, against the thesis's text on the CPU, and where they end.
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "tests/gpu/marks/stroke_fixture.h"
#include "tests/oracles/stroke_oracle.h"

namespace pleinair::marks {
namespace {

/// Bilinear interpolation of a level of the field, or of an image.
template <class T>
T bilinear(const std::vector<T>& texels, hal::FrameSize size, glm::dvec2 at) {
  const glm::dvec2 low = glm::floor(at - 0.5);
  const glm::dvec2 part = at - 0.5 - low;
  const auto texel = [&](int dx, int dy) {
    const int x = std::clamp(static_cast<int>(low.x) + dx, 0, size.width - 1);
    const int y = std::clamp(static_cast<int>(low.y) + dy, 0, size.height - 1);
    return texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) +
                  static_cast<std::size_t>(x)];
  };
  return (1.0 - part.y) * ((1.0 - part.x) * texel(0, 0) + part.x * texel(1, 0)) +
         part.y * ((1.0 - part.x) * texel(0, 1) + part.x * texel(1, 1));
}

const auto kRings = [](glm::dvec2 px) {
  return 0.5 + 0.3 * std::sin(0.35 * glm::distance(px, glm::dvec2(128.0, 64.0)));
};
const auto kUpright = [](glm::dvec2 px) { return 0.5 + 0.3 * std::sin(0.6 * px.x); };
const auto kLevel = [](glm::dvec2 px) { return 0.5 + 0.3 * std::sin(0.6 * px.y); };

class StrokeSetTest : public StrokeTest {
 protected:
  oracles::StrokeGround groundOf(const hal::Image& paint) const {
    std::vector<glm::dvec2> tensors;
    for (const FieldTexel& each : read(field_->resolved(0))) tensors.push_back(each.tensor);
    std::vector<glm::dvec3> colours;
    for (int y = 0; y < paint.size().height; ++y) {
      const auto row = paint.view().row(0, y);
      for (std::size_t x = 0; x < row.size(); x += 4) {
        colours.push_back(glm::dvec3(row[x], row[x + 1], row[x + 2]) / 255.0);
      }
    }
    const hal::FrameSize regions = field_->resolved(0).size();
    return {.tensorAt = [=](glm::dvec2 px) { return bilinear(tensors, regions, px / 8.0); },
            .colourAt =
                [=, size = paint.size()](glm::dvec2 px) { return bilinear(colours, size, px); }};
  }
};

constexpr StrokeRule kPlain{.segmentPx = 6.0F,
                            .minSteps = 0.5F,
                            .colourThreshold = 0.15F,
                            .cutOffRad = 0.5F,
                            .wanderRad = 0.0F};
constexpr oracles::StrokeWalk kPlainWalk{
    .segmentPx = 6.0, .steps = 4, .minSteps = 0.5, .colourThreshold = 0.15, .cutOffRad = 0.5};

/// A ramp of colours, in which strokes end here and there.
hal::Image ramp() {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = {256, 128}});
  for (int y = 0; y < 128; ++y) {
    auto* p = image.row(0, y).data();
    for (int x = 0; x < 256; ++x, p += 4) {
      p[0] = static_cast<std::uint8_t>(x);
      p[1] = static_cast<std::uint8_t>(2 * y);
      p[2] = static_cast<std::uint8_t>(128 + 60 * std::sin(0.05 * (x + y)));
      p[3] = 255;
    }
  }
  return image;
}

/// Whether strokes look at what is `besidePx` beside them.
class StrokesAndOracle : public StrokeSetTest, public ::testing::WithParamInterface<float> {};
INSTANTIATE_TEST_SUITE_P(Beside, StrokesAndOracle, ::testing::Values(0.0F, 8.0F));

TEST_P(StrokesAndOracle, DirectionsAndLengths) {
  const hal::Image paint = ramp();
  StrokeRule rule = kPlain;
  rule.besidePx = GetParam();
  oracles::StrokeWalk walk = kPlainWalk;
  walk.besidePx = GetParam();
  advance(greyPicture(kSize, kRings), rule, standing(), &paint);
  const oracles::StrokeGround ground = groundOf(paint);
  const std::vector<StrokeSlot> strokes = readStrokes();
  int compared = 0;
  int stopped = 0;
  int far = 0;
  for (const auto& [slot, anchor] : alive()) {
    const StrokeSlot& is = strokes[slot];
    const glm::dvec2 px(anchor.px);
    const glm::dvec2 heading = oracles::strokeDirection(ground.tensorAt(px));
    for (const bool ahead : {true, false}) {
      // Which way is ahead, the GPU may choose.
      const glm::dvec2 first(ahead ? is.ahead[0] : is.behind[0]);
      const oracles::StrokeArm arm =
          oracles::strokeArm(ground, walk, px, glm::dot(first, heading) < 0.0 ? -heading : heading);
      // Where it all but turned too much, a rounding decides; where it all but turned back, too.
      if (arm.nearestToCutOff < 0.02 || glm::length(ground.tensorAt(px)) < 0.1) continue;
      double worst = 0.0;
      const double length = ahead ? is.lengths.x : is.lengths.y;
      for (std::size_t i = 0; i < 4 && static_cast<double>(i) < length; ++i) {
        const glm::dvec2 direction(ahead ? is.ahead[i] : is.behind[i]);
        worst = std::max(worst, glm::distance(direction, arm.directions[i]));
      }
      EXPECT_LT(worst, 0.03) << px.x << "," << px.y;
      // Colours are read with 8 bits between pixels, which is a tenth of a segment of this ramp; so
      // is the lean of a step.
      EXPECT_NEAR(length, arm.length, GetParam() > 0.0F ? 0.35 : 0.25) << px.x << "," << px.y;
      far += std::abs(length - arm.length) > 0.1 ? 1 : 0;
      ++compared;
      stopped += arm.length < 4.0 ? 1 : 0;
    }
  }
  EXPECT_GT(compared, 700);
  EXPECT_LT(far, compared / 50);
  EXPECT_GT(stopped, 100) << "some are to end early";
}

TEST_F(StrokeSetTest, OneWayIsNearTheThesissSkeleton) {
  StrokeRule rule = kPlain;
  rule.bothWays = false;
  rule.colourThreshold = 2.0F;
  oracles::StrokeWalk walk = kPlainWalk;
  walk.colourThreshold = 2.0;
  const hal::Image paint = ramp();
  advance(greyPicture(kSize, kRings), rule, standing(), &paint);
  const oracles::StrokeGround ground = groundOf(paint);
  const std::vector<StrokeSlot> strokes = readStrokes();
  std::vector<double> apart;
  for (const auto& [slot, anchor] : alive()) {
    const StrokeSlot& is = strokes[slot];
    EXPECT_EQ(is.lengths.y, 0.0F);
    const glm::dvec2 px(anchor.px);
    if (glm::distance(px, {128.0, 64.0}) < 30.0) continue;  // where rings turn too much
    const std::vector<glm::dvec2> points =
        oracles::thesisSkeleton(ground, walk, px, glm::dvec2(is.ahead[0]));
    EXPECT_EQ(static_cast<double>(points.size() - 1), is.lengths.x);
    glm::dvec2 at = px;
    for (std::size_t i = 0; i < std::min<std::size_t>(4, points.size() - 1); ++i) {
      at += 6.0 * glm::dvec2(is.ahead[i]);
      if (i == 3) apart.push_back(glm::distance(at, points[i + 1]));
    }
  }
  ASSERT_GT(apart.size(), 300U);
  std::ranges::sort(apart);
  // A ring of 24 px: the thesis's step leaves the ring by half a segment's turn each time.
  EXPECT_LT(apart[apart.size() / 2], 1.5);
  EXPECT_LT(apart[apart.size() * 95 / 100], 4.0);
}

TEST_F(StrokeSetTest, EndsWhereTheColourChanges) {
  const hal::Image paint = greyPicture(kSize, [](glm::dvec2 px) { return px.x < 128 ? 0.2 : 0.8; });
  StrokeRule rule = kPlain;
  rule.minSteps = 0.0F;
  advance(greyPicture(kSize, kLevel), rule, standing(), &paint);
  int ended = 0;
  for (const StrokeTips& each : tips(rule.segmentPx)) {
    const bool isLeft = each.anchor.x < 128.0F;
    if (std::abs(each.anchor.x - 128.0F) < 1.0F) continue;  // the colour there is neither's
    for (const glm::vec2 tip : {each.ahead, each.behind}) {
      // Within the segment in which it changes; the change is known at its end only.
      EXPECT_TRUE(isLeft ? tip.x < 128.0F + 3.0F : tip.x > 128.0F - 3.0F)
          << each.anchor.x << " to " << tip.x;
      ended += std::abs(tip.x - 128.0F) < 6.0F ? 1 : 0;
    }
    EXPECT_NEAR(each.colour.r, isLeft ? 0.2 : 0.8, 0.02) << each.anchor.x;
  }
  EXPECT_GT(ended, 40);
}

/// Coarse strokes that begin on something small lie under finer ones there, and are seen beyond it.
TEST_F(StrokeSetTest, TheCoarserTheLayerTheLessCountsWhatAStrokeBeginsOn) {
  const hal::Image paint =
      greyPicture(kSize, [](glm::dvec2 px) { return std::abs(px.x - 128) < 3 ? 0.8 : 0.4; });
  StrokeRule rule = kPlain;
  rule.colourThreshold = 2.0F;  // no stroke ends there
  rule.layers = 3;
  std::array<double, 3> shares{};  // of the thing's colour in the strokes that begin on it
  for (rule.layer = 0; rule.layer < rule.layers; ++rule.layer) {
    beginAnew();
    advance(greyPicture(kSize, kLevel), rule, standing(), &paint);
    int count = 0;
    double sum = 0.0;
    for (const StrokeTips& each : tips(rule.segmentPx)) {
      if (std::abs(each.anchor.x - 128.0F) > 2.0F) continue;
      sum += (each.colour.r - 0.4) / 0.4;
      ++count;
    }
    ASSERT_GT(count, 5);
    shares.at(static_cast<std::size_t>(rule.layer)) = sum / count;
  }
  EXPECT_LT(shares[0], 0.05);
  EXPECT_LT(shares[1], 0.15);
  EXPECT_GT(shares[2], 0.25) << "small lights would vanish";
}

TEST_F(StrokeSetTest, EndsWhereItWouldBendTooMuch) {
  const hal::Image picture =
      greyPicture(kSize, [](glm::dvec2 px) { return px.x < 128 ? kLevel(px) : kUpright(px); });
  const hal::Image paint = greyPicture(kSize, [](glm::dvec2) { return 0.5; });
  for (const float cutOff : {0.3F, 1.6F}) {
    beginAnew();
    StrokeRule rule = kPlain;
    rule.segmentPx = 8.0F;
    rule.cutOffRad = cutOff;
    advance(picture, rule, standing(), &paint);
    int ended = 0;
    for (const auto& [slot, anchor] : alive()) {
      if (anchor.px.x < 100.0F || anchor.px.x > 122.0F) continue;
      const StrokeSlot stroke = readStrokes()[slot];
      ended += std::min(stroke.lengths.x, stroke.lengths.y) < 4.0F ? 1 : 0;
    }
    if (cutOff < 1.0F) {
      EXPECT_GT(ended, 10);
    } else {
      EXPECT_EQ(ended, 0);
    }
  }
}

/// A model's strokes stay on it. Those of the image go on behind it with the image's colours; where
/// it is drawn, they are clipped (borders.frag).
TEST_F(StrokeSetTest, AModelsStrokesEndAtItsOutlineAndTheImagesGoOnBehindIt) {
  const auto isInside = [](glm::vec2 px) {
    return px.x >= 80.0F && px.x < 150.0F && px.y >= 30.0F && px.y < 100.0F;
  };
  useObject(isInside);
  hal::Image paint = greyPicture(kSize, [](glm::dvec2) { return 0.5; });
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      if (!isInside({x, y})) continue;
      paint.row(0, y)[static_cast<std::size_t>(x) * 4] = 200;
    }
  }
  StrokeRule rule = kPlain;
  rule.colourThreshold = 5.0F;  // it is not the colour that ends them
  rule.minSteps = 0.0F;
  rule.widthPx = 1.0F;  // the least that is painted is a dab as wide
  advance(greyPicture(kSize, kLevel), rule, standing(), &paint);
  int onObject = 0;
  const auto depthOf = [](glm::vec2 px) {  // in the object; below 0: beyond its edge
    return std::min({px.x - 80.0F, 150.0F - px.x, px.y - 30.0F, 100.0F - px.y});
  };
  int ended = 0;
  int behindObject = 0;
  for (const StrokeTips& each : tips(rule.segmentPx, -0.2F)) {
    const bool isOn = each.surface != 0;
    onObject += isOn ? 1 : 0;
    EXPECT_EQ(isOn, isInside(each.anchor));
    if (isOn) {
      EXPECT_TRUE(isInside(each.ahead)) << each.anchor.x << "," << each.anchor.y;
      EXPECT_TRUE(isInside(each.behind)) << each.anchor.x << "," << each.anchor.y;
      ended += glm::distance(each.ahead, each.behind) < 36.0F ? 1 : 0;
    } else {
      const float deepest = std::max(depthOf(each.ahead), depthOf(each.behind));
      behindObject += deepest > 2.0F ? 1 : 0;
      EXPECT_LT(deepest, 0.025F * static_cast<float>(kSize.width) + 1.0F) << each.anchor.x;
    }
    const float fromEdge =
        std::min(std::abs(each.anchor.x - 80.0F), std::abs(each.anchor.x - 150.0F));
    if (fromEdge > 1.0F && std::abs(each.anchor.y - 30.0F) > 1.0F &&
        std::abs(each.anchor.y - 100.0F) > 1.0F) {
      EXPECT_NEAR(each.colour.r, isOn ? 200.0 / 255.0 : 0.5, 0.03) << each.anchor.x;
    }
  }
  for (const StrokeInstance& each : readInstances()) {
    if (each.label == 0.0F) continue;  // of the image
    float deepest = -1e9F;
    float least = 1e9F;
    for (const glm::vec2 point : each.points) {
      deepest = std::max(deepest, depthOf(point));
      least = std::min(least, depthOf(point));
    }
    EXPECT_FALSE(deepest > 1.5F && least < -1.5F) << "is painted over the edge";
  }
  EXPECT_GT(onObject, 50);
  EXPECT_GT(ended, 20);
  EXPECT_GT(behindObject, 15);
}

TEST_F(StrokeSetTest, FineStrokesStayWhereThereIsDetail) {
  // Detail on the left, none on the right; strokes would run across.
  const hal::Image picture =
      greyPicture(kSize, [](glm::dvec2 px) { return px.x < 128 ? kLevel(px) : 0.5; });
  const hal::Image paint = greyPicture(kSize, [](glm::dvec2) { return 0.5; });
  const auto reachOf = [&](glm::vec2 band) {
    beginAnew();
    StrokeRule rule = kPlain;
    rule.segmentPx = 10.0F;
    rule.detailBand = band;
    advance(picture, rule, standing(), &paint);
    float reach = 0.0F;
    int wanted = 0;
    for (const StrokeTips& each : tips(rule.segmentPx)) {
      if (each.seen <= 0.0F) continue;
      ++wanted;
      reach = std::max({reach, each.ahead.x, each.behind.x});
    }
    EXPECT_GT(wanted, 20);
    return reach;
  };
  EXPECT_LT(reachOf({0.5F, 1e9F}), 150.0F);
  EXPECT_GT(reachOf({-1.0F, 1e9F}), 250.0F) << "coarse ones may cross";
}

TEST_F(StrokeSetTest, InstancesLieOnTheirSkeletons) {
  StrokeRule rule = kPlain;
  rule.opacity = 0.8F;
  rule.widthSpread = 0.3F;
  const hal::Image paint = ramp();
  advance(greyPicture(kSize, kRings), rule, standing(), &paint);
  const std::vector<StrokeInstance> instances = readInstances();
  const std::vector<StrokeTips> skeletons = tips(rule.segmentPx);
  ASSERT_EQ(instances.size(), skeletons.size()) << "all are seen";
  const std::vector<unsigned> command = support::readBuffer<unsigned>(strokes_->command());
  EXPECT_EQ(command[0], static_cast<unsigned>(StrokeSet::verticesOf(rule.quads)));
  EXPECT_EQ(command[2], 0U);
  std::set<float> variants;
  std::size_t whole = 0;
  for (const StrokeInstance& each : instances) {
    variants.insert(each.variant);
    EXPECT_GE(each.halfWidth, 0.5F * rule.widthPx * 0.7F - 0.01F);
    EXPECT_LE(each.halfWidth, 0.5F * rule.widthPx * 1.3F + 0.01F);
    EXPECT_LE(each.paint.a, 0.8F + 1e-6F);
    whole += each.paint.a > 0.8F - 1e-6F ? 1 : 0;
    // Equal parts, but for corners that a chord cuts.
    const float part = glm::distance(each.points[0], each.points[1]);
    for (std::size_t i = 1; i < 7; ++i) {
      EXPECT_LE(glm::distance(each.points[i], each.points[i + 1]), 1.15F * part + 0.05F);
    }
    // The polyline that a skeleton is has all of its points.
    const auto nearest = [&](const StrokeTips& skeleton) {
      float worst = 0.0F;
      for (const glm::vec2 point : each.points) {
        float least = 1e9F;
        for (std::size_t i = 0; i + 1 < skeleton.polyline.size(); ++i) {
          const glm::vec2 a = skeleton.polyline[i];
          const glm::vec2 along = skeleton.polyline[i + 1] - a;
          const float t = std::clamp(
              glm::dot(point - a, along) / std::max(glm::dot(along, along), 1e-6F), 0.0F, 1.0F);
          least = std::min(least, glm::distance(point, a + t * along));
        }
        worst = std::max(worst, least);
      }
      return worst;
    };
    float best = 1e9F;
    for (const StrokeTips& skeleton : skeletons) best = std::min(best, nearest(skeleton));
    EXPECT_LT(best, 0.02F);
  }
  EXPECT_EQ(variants, (std::set<float>{0.0F, 1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F, 7.0F}));
  EXPECT_GT(whole, instances.size() * 3 / 4) << "few are specks";
}

TEST_F(StrokeSetTest, SpecksArePaintedThinly) {
  StrokeRule rule = kPlain;
  rule.opacity = 0.8F;
  rule.minSteps = 0.3F;
  // Where every pixel is of another colour, strokes are cut short on both sides.
  const hal::Image paint = greyPicture(
      kSize, [](glm::dvec2) { return 0.5; }, 90.0);
  advance(greyPicture(kSize, kRings), rule, standing(), &paint);
  std::size_t thin = 0;
  const std::vector<StrokeInstance> instances = readInstances();
  for (const StrokeInstance& each : instances) thin += each.paint.a < 0.75F ? 1 : 0;
  EXPECT_GT(thin, instances.size() / 2);
}

TEST(StrokeOracle, SplinesBeginAndEndAtTheirEnds) {
  std::vector<glm::dvec2> points;
  points.reserve(11);
  for (int i = 0; i < 11; ++i) points.emplace_back(10.0 * i, 5.0 * std::sin(i));
  const std::vector<glm::dvec2> samples = oracles::thesisSplineSamples(points);
  EXPECT_EQ(samples.size(), 49U) << "figure 19: eleven points give 48 quads";
  EXPECT_LT(glm::distance(samples.front(), points.front()), 1e-9);
  EXPECT_LT(glm::distance(samples.back(), points.back()), 1e-9);
  // Points in a line give a line.
  for (int i = 0; i < 4; ++i) points[static_cast<std::size_t>(i)] = {10.0 * i, 0.0};
  points.resize(4);
  for (const glm::dvec2& each : oracles::thesisSplineSamples(points)) EXPECT_EQ(each.y, 0.0);
}

}  // namespace
}  // namespace pleinair::marks
