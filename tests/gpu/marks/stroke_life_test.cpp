// Strokes in time: what they keep of their past, how they come and go, and their order.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <tuple>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "tests/gpu/marks/stroke_fixture.h"

namespace pleinair::marks {
namespace {

using std::chrono::milliseconds;

const auto kUpright = [](glm::dvec2 px) { return 0.5 + 0.3 * std::sin(0.6 * px.x); };
/// Its strokes lean by 0.5 rad from kUpright's.
const auto kLeaning = [](glm::dvec2 px) {
  return 0.5 + 0.3 * std::sin(0.6 * (px.x * std::cos(0.5) + px.y * std::sin(0.5)));
};
const auto kGrey = [](glm::dvec2) { return 0.5; };

constexpr hal::Duration kNone{0};
constexpr hal::Duration kEver = std::chrono::hours(1000);

/// Nothing random, nothing forgotten unless a test says so.
constexpr StrokeRule kPlain{.colourThreshold = 5.0F,
                            .cutOffRad = 3.0F,
                            .wanderRad = 0.0F,
                            .jitter = glm::vec3(0.0F),
                            .shapeMemory = kEver,
                            .colourMemory = kEver,
                            .appearing = kEver,
                            .vanishing = kEver,
                            .maxColourPerSecond = 1e6F};

/// Between lines, in [0, π/2].
double angleBetween(glm::vec2 a, glm::vec2 b) {
  return std::acos(std::clamp(std::abs(static_cast<double>(glm::dot(a, b))), 0.0, 1.0));
}

class StrokeLife : public StrokeTest {
 protected:
  /// Over all strokes whose anchor is well inside the picture.
  std::vector<StrokeSlot> inner() const {
    const std::vector<StrokeSlot> strokes = readStrokes();
    std::vector<StrokeSlot> found;
    for (const auto& [slot, anchor] : alive()) {
      if (anchor.px.x > 40.0F && anchor.px.x < 216.0F && anchor.px.y > 40.0F &&
          anchor.px.y < 88.0F) {
        found.push_back(strokes[slot]);
      }
    }
    EXPECT_GT(found.size(), 50U);
    return found;
  }
};

/// The share of the past is e^(−t/τ), in one step or in many.
TEST_F(StrokeLife, HistoryIsForgottenInTimeAndNotInFrames) {
  const hal::Image before = greyPicture(kSize, kUpright);
  const hal::Image now = greyPicture(kSize, kLeaning);
  const hal::Image dark = greyPicture(kSize, [](glm::dvec2) { return 0.2; });
  const hal::Image light = greyPicture(kSize, [](glm::dvec2) { return 0.8; });
  StrokeRule rule = kPlain;
  rule.shapeMemory = milliseconds(650);
  rule.colourMemory = milliseconds(300);
  for (const int frames : {1, 6, 24}) {
    SCOPED_TRACE(frames);
    beginAnew();
    advance(before, rule, standing(), &dark);
    for (int i = 0; i < frames; ++i) {
      advance(now, rule, standing(), &light, milliseconds(480) / frames);
    }
    const double turned = 0.5 - std::atan(std::tan(0.5) * std::exp(-0.480 / 0.650));
    const double colour = 0.8 - 0.6 * std::exp(-0.480 / 0.300);
    for (const StrokeSlot& each : inner()) {
      EXPECT_NEAR(angleBetween(each.ahead[0], {0.0F, 1.0F}), turned, 0.015);
      EXPECT_NEAR(angleBetween(each.behind[1], {0.0F, 1.0F}), turned, 0.015);
      EXPECT_NEAR(each.colour.g, colour, 0.01);
    }
  }
}

TEST_F(StrokeLife, ThePastEndsOnOtherContent) {
  const hal::Image before = greyPicture(kSize, kUpright);
  const hal::Image now = greyPicture(kSize, kLeaning);
  const hal::Image dark = greyPicture(kSize, [](glm::dvec2) { return 0.2; });
  const hal::Image light = greyPicture(kSize, [](glm::dvec2) { return 0.8; });
  StrokeRule rule = kPlain;
  for (const float surely : {0.5F, 5.0F}) {  // two greys are 1.04 apart
    SCOPED_TRACE(surely);
    rule.otherColour = {0.5F * surely, surely};
    beginAnew();
    advance(before, rule, standing(), &dark);
    advance(now, rule, standing(), &light, milliseconds(30));
    const bool isOther = surely < 1.0F;
    for (const StrokeSlot& each : inner()) {
      EXPECT_NEAR(each.colour.g, isOther ? 0.8 : 0.2, 0.01);
      EXPECT_NEAR(angleBetween(each.ahead[0], {0.0F, 1.0F}), isOther ? 0.5 : 0.0, 0.03);
    }
  }
}

TEST_F(StrokeLife, WhereThereIsNoDetailShapesAreHeldLonger) {
  const hal::Image before = greyPicture(kSize, kUpright);
  const hal::Image now = greyPicture(kSize, kLeaning);
  StrokeRule rule = kPlain;
  rule.shapeMemory = milliseconds(100);
  rule.flatHold = 100.0F;
  for (const float detail : {1e-3F, 1e3F}) {  // below, and above which there is little
    SCOPED_TRACE(detail);
    rule.flatDetail = {detail, 1.1F * detail};
    beginAnew();
    advance(before, rule);
    for (int i = 0; i < 10; ++i) advance(now, rule, standing(), nullptr, milliseconds(60));
    for (const StrokeSlot& each : inner()) {
      EXPECT_NEAR(angleBetween(each.ahead[0], {0.0F, 1.0F}), detail < 1.0F ? 0.5 : 0.03, 0.03);
    }
  }
}

TEST_F(StrokeLife, WithoutMemoryEachFrameIsAlone) {
  StrokeRule rule = kPlain;
  rule.shapeMemory = rule.colourMemory = rule.appearing = rule.vanishing = kNone;
  const hal::Image light = greyPicture(kSize, [](glm::dvec2) { return 0.8; });
  advance(greyPicture(kSize, kUpright), rule);
  advance(greyPicture(kSize, kLeaning), rule, standing(), &light);
  for (const StrokeSlot& each : inner()) {
    EXPECT_NEAR(angleBetween(each.ahead[0], {0.0F, 1.0F}), 0.5, 0.03);
    EXPECT_NEAR(each.colour.g, 0.8, 0.005);
  }
}

TEST_F(StrokeLife, AColourChangesNoFasterThanItMay) {
  StrokeRule rule = kPlain;
  rule.colourMemory = kNone;
  rule.maxColourPerSecond = 0.6F;
  const hal::Image picture = greyPicture(kSize, kUpright);
  const hal::Image dark = greyPicture(kSize, [](glm::dvec2) { return 0.2; });
  const hal::Image light = greyPicture(kSize, [](glm::dvec2) { return 0.8; });
  advance(picture, rule, standing(), &dark);
  for (int i = 0; i < 10; ++i) advance(picture, rule, standing(), &light, milliseconds(30));
  for (const StrokeSlot& each : inner()) {
    EXPECT_NEAR(glm::length(each.colour - glm::vec3(0.2F)), 0.6 * 0.3, 0.01);
  }
}

TEST_F(StrokeLife, ThePastTurnsWithWhatItIsOn) {
  constexpr double kRoll = 0.04;
  constexpr int kFrames = 8;
  // When the picture goes blank, only history is left.
  const hal::Image blank = greyPicture(kSize, kGrey);
  for (const double along : {1.0, -1.0, 0.0}) {
    beginAnew();
    sequence_ += 10;  // nothing is known of the way here
    advance(greyPicture(kSize, kUpright), kPlain);
    for (int i = 0; i < kFrames; ++i) advance(blank, kPlain, following(rolled(along * kRoll)));
    const double angle = std::numbers::pi / 2.0 + along * kRoll * kFrames;
    const glm::vec2 expected(std::cos(angle), std::sin(angle));
    for (const auto& [slot, anchor] : alive()) {
      // Who was born on the way has no past.
      if (anchor.ageSeconds() < 0.25F || glm::distance(anchor.px, {128.0F, 64.0F}) > 40.0F)
        continue;
      const StrokeSlot stroke = readStrokes()[slot];
      EXPECT_LT(angleBetween(stroke.ahead[0], expected), 0.02) << along;
      EXPECT_LT(angleBetween(stroke.behind[0], expected), 0.02) << along;
      EXPECT_LT(glm::dot(stroke.ahead[0], stroke.behind[0]), 0.0F);
    }
  }
}

/// Stripes whose strokes lie at `angle`, in rad from level.
hal::Image stripes(hal::FrameSize size, double angle) {
  const glm::dvec2 across(std::sin(angle), -std::cos(angle));
  const glm::dvec2 middle(size.width / 2.0, size.height / 2.0);
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = size});
  for (int y = 0; y < size.height; ++y) {
    auto* p = image.row(0, y).data();
    for (int x = 0; x < size.width; ++x, p += 4) {
      const double phase = 0.6 * glm::dot(glm::dvec2(x + 0.5, y + 0.5) - middle, across);
      p[0] = p[1] = p[2] = static_cast<std::uint8_t>(std::lround(127.5 + 76.5 * std::sin(phase)));
      p[3] = 255;
    }
  }
  return image;
}

TEST_F(StrokeLife, ATurnBy80DegreesIsTakenStepByStep) {
  constexpr double kTurn = 80.0 * std::numbers::pi / 180.0;
  StrokeRule rule = kPlain;
  rule.shapeMemory = milliseconds(650);
  const hal::Image grey = greyPicture(kSize, kGrey);
  advance(stripes(kSize, 0.3), rule, standing(), &grey);
  const hal::Image turned = stripes(kSize, 0.3 + kTurn);
  double left = kTurn;
  for (int i = 0; i < 12; ++i) {
    advance(turned, rule, standing(), &grey, milliseconds(100));
    left = std::atan(std::tan(left) * std::exp(-100.0 / 650.0));
    const double angle = 0.3 + kTurn - left;
    const glm::vec2 expected(std::cos(angle), std::sin(angle));
    for (const StrokeSlot& each : inner()) {
      EXPECT_LT(angleBetween(each.ahead[0], expected), 0.06) << i;
      EXPECT_LT(angleBetween(each.behind[3], expected), 0.06) << i;
      // One line, whatever its directions' signs were.
      for (std::size_t k = 1; k < 4; ++k) {
        EXPECT_GT(glm::dot(each.ahead[k], each.ahead[k - 1]), 0.9F);
        EXPECT_GT(glm::dot(each.behind[k], each.behind[k - 1]), 0.9F);
      }
      EXPECT_LT(glm::dot(each.ahead[0], each.behind[0]), -0.9F);
    }
  }
}

/// A camera that rolls by 30° a second: memory of 0.65 s would lag by 21° if it were not carried.
TEST_F(StrokeLife, ARollingPicturesStrokesDoNotLag) {
  constexpr double kRoll = std::numbers::pi / 6.0 * 0.033;
  StrokeRule rule = kPlain;
  rule.shapeMemory = milliseconds(650);
  const hal::Image grey = greyPicture(kSize, kGrey);
  const auto lagOf = [&](bool isTold) {
    beginAnew();
    sequence_ += 10;
    double angle = 0.0;
    for (int i = 0; i < 50; ++i) {
      advance(stripes(kSize, angle), rule, isTold && i > 0 ? following(rolled(kRoll)) : standing(),
              &grey);
      angle += kRoll;
    }
    angle -= kRoll;
    const glm::vec2 truth(std::cos(angle), std::sin(angle));
    double worst = 0.0;
    const std::vector<StrokeSlot> strokes = readStrokes();
    for (const auto& [slot, anchor] : alive()) {
      if (glm::distance(anchor.px, {128.0F, 64.0F}) > 40.0F || anchor.ageSeconds() < 1.0F) continue;
      worst = std::max(worst, angleBetween(strokes[slot].ahead[1], truth));
    }
    return worst * 180.0 / std::numbers::pi;
  };
  EXPECT_LT(lagOf(true), 2.5);
  EXPECT_GT(lagOf(false), 15.0) << "the control";
}

TEST_F(StrokeLife, ComesAndGoesInTime) {
  StrokeRule rule = kPlain;
  rule.appearing = milliseconds(300);
  rule.vanishing = milliseconds(200);
  const hal::Image picture = greyPicture(kSize, kUpright);
  for (const int frames : {3, 12}) {
    beginAnew();
    rule.detailBand = {-1.0F, 1e9F};
    advance(picture, rule);
    for (const StrokeSlot& each : inner()) EXPECT_EQ(each.seen, 1.0F) << "the first frame has all";
    rule.detailBand = {1e8F, 1e9F};
    for (int i = 0; i < frames; ++i) {
      advance(picture, rule, standing(), nullptr, milliseconds(240) / frames);
    }
    for (const StrokeSlot& each : inner()) EXPECT_NEAR(each.seen, std::exp(-240.0 / 200.0), 0.005);
    rule.detailBand = {-1.0F, 1e9F};
    for (int i = 0; i < frames; ++i) {
      advance(picture, rule, standing(), nullptr, milliseconds(240) / frames);
    }
    const double back = 1.0 - (1.0 - std::exp(-240.0 / 200.0)) * std::exp(-240.0 / 300.0);
    for (const StrokeSlot& each : inner()) EXPECT_NEAR(each.seen, back, 0.005);
    rule.detailBand = {1e8F, 1e9F};
    for (int i = 0; i < 40; ++i) advance(picture, rule);
    for (const StrokeSlot& each : inner()) EXPECT_EQ(each.seen, 0.0F) << "gone for good";
    EXPECT_TRUE(readInstances().empty());
  }
}

TEST_F(StrokeLife, WhatIsThereStaysALittleLonger) {
  const hal::Image picture = greyPicture(kSize, kUpright);
  StrokeRule rule = kPlain;
  advance(picture, rule);
  const std::vector<FieldTexel> texels = read(field_->resolved(1));
  const auto detail = static_cast<float>(texels[16 * 4 + 8].detail);
  const auto wantedAt = [&](float part) {
    rule.detailBand = {detail * part, 1e9F};
    advance(picture, rule);
    int wanted = 0;
    for (const StrokeSlot& each : inner()) wanted += (each.state & 0x80000000U) != 0U ? 1 : 0;
    return static_cast<double>(wanted) / static_cast<double>(inner().size());
  };
  EXPECT_EQ(wantedAt(0.9F), 1.0);
  EXPECT_EQ(wantedAt(1.2F), 1.0) << "they were there";
  EXPECT_EQ(wantedAt(1.5F), 0.0);
  EXPECT_EQ(wantedAt(1.2F), 0.0) << "and now they were not";
  EXPECT_EQ(wantedAt(0.9F), 1.0);
}

/// Under a pan and a roll, with births and deaths: of any two strokes that live on, the one that
/// was painted first still is.
TEST_F(StrokeLife, TheOrderOfPaintingNeverChanges) {
  StrokeRule rule = kPlain;
  rule.jitter = {0.2F, 0.4F, 0.4F};  // by which a stroke is known again
  rule.widthSpread = 0.4F;
  const hal::Image picture = greyPicture(kSize, kGrey);
  using Name = std::tuple<float, float, float, float>;
  std::map<Name, std::size_t> before;
  int compared = 0;
  int born = 0;
  for (int i = 0; i < 30; ++i) {
    glm::dmat3 motion = rolled(0.01);
    motion[2].x += 3.0;
    advance(picture, rule, i == 0 ? standing() : following(motion));
    const std::vector<StrokeInstance> instances = readInstances();
    std::map<Name, std::size_t> now;
    std::size_t last = 0;
    for (std::size_t rank = 0; rank < instances.size(); ++rank) {
      const StrokeInstance& each = instances[rank];
      if (each.paint.a < 1.0F) continue;  // widths grow with what comes
      const Name name{each.halfWidth, each.paint.r, each.paint.g, each.paint.b};
      EXPECT_TRUE(now.emplace(name, rank).second) << "two of one name";
      const auto known = before.find(name);
      if (known == before.end()) {
        ++born;
        continue;
      }
      EXPECT_GE(known->second, last) << "frame " << i;
      last = known->second;
      ++compared;
    }
    before = std::move(now);
  }
  EXPECT_GT(compared, 5000);
  EXPECT_GT(born, 500);
}

TEST_F(StrokeLife, TheSameFramesGiveTheSameStrokes) {
  std::vector<std::vector<StrokeSlot>> runs;
  for (int run = 0; run < 2; ++run) {
    time_ = {};
    sequence_ = 0;
    motionField_.emplace(library_, kSize);
    beginAnew();
    for (unsigned i = 0; i < 4; ++i) {
      advance(greyPicture(kSize, variedLuma, 3.0, i), {}, following(rolled(0.01)));
    }
    runs.push_back(readStrokes());
  }
  ASSERT_EQ(runs[0].size(), runs[1].size());
  EXPECT_EQ(std::memcmp(runs[0].data(), runs[1].data(), runs[0].size() * sizeof(StrokeSlot)), 0);
}

}  // namespace
}  // namespace pleinair::marks
