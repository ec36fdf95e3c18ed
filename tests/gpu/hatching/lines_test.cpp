// Lines of hatching: nested ranks, places and widths as the oracle has them, directions, spacing,
// borders.
#include <algorithm>
#include <complex>
#include <set>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gmock/gmock.h>

#include "tests/gpu/hatching/hatching_fixture.h"

namespace pleinair::styles {
namespace {

class HatchLinesTest : public HatchingTest {
 protected:
  /// The ink of a first frame of one tone.
  std::vector<std::uint8_t> inkOfTone(double luma, const char* seed = "1") {
    Hatching style(library_);
    set(style, {{"seed", seed}, {"grain", "0"}, {"opacity", "1"}, {"lighten", "0"}});
    restart();
    style.paint(next(flat(luma)), {});
    slots_ = 0;
    seen_.clear();
    for (std::size_t i = 0; i < style.setCount(); ++i) {
      const auto lines = storedLines(style.set(i));
      for (std::size_t slot = 0; slot < lines.size(); ++slot) {
        if (lines[slot].seen > 0.01F) seen_.insert(slots_ + slot);
      }
      slots_ += lines.size();
    }
    return inkOf(style);
  }
  /// Pixels with less ink in the second than in the first, by more than rounding.
  static int lessInk(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
    int count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) count += b[i] + 3 < a[i] ? 1 : 0;
    return count;
  }

  std::size_t slots_ = 0;
  std::set<std::size_t> seen_;
};

TEST_F(HatchLinesTest, ADarkerToneHasAllLinesOfALighterOneAndMore) {
  // Wider lines are strips of other quads, which are within 0.3 px of their curve.
  constexpr int kRounded = 60;
  std::vector<std::uint8_t> lighter = inkOfTone(1.0);
  std::set<std::size_t> seenLighter = seen_;
  EXPECT_EQ(meanOf(lighter), 0.0);  // bare paper
  for (const double luma : {0.75, 0.6, 0.45, 0.3, 0.15}) {
    SCOPED_TRACE(luma);
    const std::vector<std::uint8_t> darker = inkOfTone(luma);
    EXPECT_GT(meanOf(darker), meanOf(lighter) + 2.0);
    EXPECT_LE(lessInk(lighter, darker), kRounded);
    EXPECT_TRUE(std::ranges::includes(seen_, seenLighter));
    EXPECT_GT(seen_.size(), seenLighter.size());
    lighter = darker;
    seenLighter = seen_;
  }
  EXPECT_GT(meanOf(lighter), 120.0);
  // Control: lines of another drawing are no part of these.
  EXPECT_GT(lessInk(inkOfTone(0.4, "2"), inkOfTone(0.25)), 500);
}

/// shaders/tone.glsl.
double oracleHalfWidth(double luma, double rank, const HatchRule& rule) {
  const double dark = rule.isInverted ? luma : 1.0 - luma;
  const double tone = std::pow(std::clamp(rule.darkness * dark, 0.0, 1.0), double{rule.gamma});
  const double inBand = std::clamp((tone - rule.band.x) / (rule.band.y - rule.band.x), 0.0, 1.0);
  const double past = std::clamp((inBand - rank * (1.0 - rule.swell)) / rule.swell, 0.0, 1.0);
  return 0.5 * rule.widthPx * past * past * (3.0 - 2.0 * past);
}

// On one tone, with nothing that leads them, lines are straight, as long as their arms, and as wide
// as the tone asks for, less at their ends.
TEST_F(HatchLinesTest, AreWhereAndAsWideAsTheOraclesSay) {
  for (const double luma : {0.7, 0.4}) {
    for (const bool isInverted : {false, true}) {
      Hatching style(library_);
      set(style, {{"lead", "0"},
                  {"wander", "0"},
                  {"slope", "20"},
                  {"directions", "1"},
                  {"paper_tone", "0.1"},
                  {"taper", "0.25"},
                  {"inverted", isInverted ? "true" : "false"}});
      restart();
      style.paint(next(flat(luma)), {});
      const HatchingParameters p = hatchingParameters().typed(style.parameters());
      const double scale = scaleOf(kSize);
      HatchRule rule;
      rule.isInverted = isInverted;
      rule.darkness = static_cast<float>(p.darkness);
      rule.gamma = static_cast<float>(p.gamma);
      rule.swell = static_cast<float>(p.swell);
      rule.widthPx = static_cast<float>(p.width * scale);
      rule.band = {0.1F, 1.0F};
      const HatchLines& lines = style.set(0);
      const std::vector<marks::Anchor> anchors = lines.anchors().read();
      const std::vector<StoredLine> stored = storedLines(lines);
      const std::vector<DrawnLine> drawn = drawnLines(lines);
      ASSERT_GT(drawn.size(), 50U);
      const double slope = glm::radians(-20.0);
      const glm::dvec2 along(std::cos(slope), std::sin(slope));
      const double segment = p.length * scale / 16.0;
      std::size_t number = 0;
      for (std::size_t slot = 0; slot < stored.size(); ++slot) {
        if (!anchors[slot].isAlive() || stored[slot].seen <= 0.01F) continue;
        const DrawnLine& line = drawn.at(number++);
        const glm::dvec2 from = glm::dvec2(anchors[slot].px) + glm::dvec2(stored[slot].shift);
        const glm::dvec2 span(line.points[15] - line.points[0]);
        const double sense = glm::dot(span, along) < 0.0 ? -1.0 : 1.0;
        for (std::size_t i = 0; i < 16; ++i) {
          const double part = static_cast<double>(i) / 15.0;
          const double s =
              -stored[slot].lengths.y + part * (stored[slot].lengths.x + stored[slot].lengths.y);
          const glm::dvec2 wanted = from + sense * segment * s * along;
          ASSERT_LT(glm::distance(wanted, glm::dvec2(line.points[i])), 0.02) << slot << " " << i;
          const double t = std::clamp((std::min(part, 1.0 - part) + 0.02) / 0.27, 0.0, 1.0);
          const double pressure = t * t * (3.0 - 2.0 * t);
          const double luma8 = std::round(luma * 255.0) / 255.0;
          ASSERT_NEAR(line.halfWidths[i],
                      pressure * oracleHalfWidth(luma8, stored[slot].rank, rule), 0.01)
              << slot << " " << i;
        }
      }
      EXPECT_EQ(number, drawn.size());
    }
  }
}

/// The angle, in degrees, between lines in the picture's middle ring and that of the ring.
double meanAngleToRings(const std::vector<DrawnLine>& lines, glm::vec2 middle) {
  double sum = 0.0;
  int count = 0;
  for (const DrawnLine& line : lines) {
    const glm::vec2 radial = 0.5F * (line.points[7] + line.points[8]) - middle;
    if (glm::length(radial) < 25.0F || glm::length(radial) > 60.0F) continue;
    const glm::vec2 along = line.points[8] - line.points[7];
    if (glm::length(along) < 1e-3F) continue;
    sum += glm::degrees(std::asin(
        std::min(1.0F, std::abs(glm::dot(glm::normalize(radial), glm::normalize(along))))));
    ++count;
  }
  EXPECT_GT(count, 20);
  return sum / count;
}

TEST_F(HatchLinesTest, RunAlongTheFieldAndAcrossItAtTheirAngle) {
  const glm::vec2 middle(96.0F, 72.0F);
  const hal::Image rings = imageOf(kSize, [&](int x, int y) {
    return 0.25 + 0.15 * std::sin(glm::distance(glm::vec2(x, y), middle) * 0.6);
  });
  Hatching style(library_);
  set(style, {{"lead", "1"}, {"wander", "0"}, {"cross", "60"}});
  style.paint(next(rings), {});
  EXPECT_LT(meanAngleToRings(drawnLines(style.set(0)), middle), 8.0);
  EXPECT_NEAR(meanAngleToRings(drawnLines(style.set(1)), middle), 60.0, 8.0);
  EXPECT_NEAR(meanAngleToRings(drawnLines(style.set(2)), middle), 60.0, 8.0);
}

// How well parallel lines are in step, in [0, 1], over the neighbours of each.
double agreementOf(const std::vector<DrawnLine>& lines, double spacing) {
  double sum = 0.0;
  int count = 0;
  for (const DrawnLine& one : lines) {
    const glm::vec2 along = glm::normalize(one.points[15] - one.points[0]);
    const glm::vec2 across(-along.y, along.x);
    std::complex<double> phases = 0.0;
    int near = 0;
    for (const DrawnLine& other : lines) {
      const glm::vec2 apart = other.points[8] - one.points[8];
      if (&one == &other || glm::length(apart) > 4.0 * spacing) continue;
      phases += std::polar(1.0, 2.0 * M_PI * glm::dot(apart, across) / spacing);
      ++near;
    }
    if (near < 3) continue;
    sum += phases.real() / near;
    ++count;
  }
  EXPECT_GT(count, 50);
  return sum / count;
}

TEST_F(HatchLinesTest, AreSpacedEvenly) {
  const double spacing = 5.0 * scaleOf(kSize);
  const auto agreement = [&](const char* evenness) {
    Hatching style(library_);
    set(style, {{"lead", "0"},
                {"wander", "0"},
                {"directions", "1"},
                {"spacing", "5"},
                {"evenness", evenness}});
    restart();
    style.paint(next(flat(0.1)), {});
    return agreementOf(drawnLines(style.set(0)), spacing);
  };
  EXPECT_GT(agreement("1"), 0.8);
  EXPECT_LT(agreement("0"), 0.3);
}

class HatchBorders : public HatchLinesTest {
 protected:
  static bool isInBox(glm::vec2 px, float margin) {
    return px.x > 60 + margin && px.x < 130 - margin && px.y > 40 + margin && px.y < 100 - margin;
  }
  /// Control points of lines that lie clearly in another thing than their line's, on a picture of
  /// one tone with a model in its middle; unknown to the style, if so told.
  int strays(bool isKnown, bool hasPatches = false) {
    std::vector<std::uint32_t> ids;
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        ids.push_back(isInBox(glm::vec2(x, y) + 0.5F, 0.0F) ? 1U << scene::kTriangleBits | 7U : 0U);
      }
    }
    const std::size_t stride = static_cast<std::size_t>(kSize.width) * 4;
    gpu::Texture idTexture(gpu::TextureFormat::kR32ui, kSize);
    idTexture.upload({reinterpret_cast<const std::uint8_t*>(ids.data()), ids.size() * 4}, stride);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const bool isSecond = hasPatches && i % static_cast<std::size_t>(kSize.width) >= kPatches;
      ids[i] = ids[i] == 0U ? 0U : (isSecond ? 2U : 1U);
    }
    gpu::Texture labels(gpu::TextureFormat::kR32ui, kSize);
    labels.upload({reinterpret_cast<const std::uint8_t*>(ids.data()), ids.size() * 4}, stride);
    gpu::Texture zeros(gpu::TextureFormat::kR32ui, kSize);
    zeros.upload(std::vector<std::uint8_t>(ids.size() * 4), stride);
    Hatching style(library_);
    set(style, {{"lead", "0"}, {"length", "160"}, {"evenness", "0"}});
    restart();
    scene::ArFrame frame = next(flat(0.2));
    frame.hasObjects = isKnown;
    frame.ids = &idTexture;
    frame.barycentrics = &zeros;
    frame.forms = &labels;
    frame.normalFocus = &picture_;
    style.paint(frame, {});
    int count = 0;
    onModel_ = 0;
    overPatches_ = 0;
    for (std::size_t i = 0; i < style.setCount(); ++i) {
      // arms end within a segment behind the border
      const float margin = style.set(i).segmentPx();
      for (const DrawnLine& line : drawnLines(style.set(i))) {
        onModel_ += line.object != 0.0F ? 1 : 0;
        const auto [left, right] =
            std::ranges::minmax(line.points, {}, [](glm::vec2 point) { return point.x; });
        const bool isOver = left.x < kPatches - margin && right.x > kPatches + margin;
        overPatches_ += line.object != 0.0F && isOver ? 1 : 0;
        for (const glm::vec2 point : line.points) {
          count += line.object == 0.0F ? isInBox(point, margin) : !isInBox(point, -margin);
        }
      }
    }
    return count;
  }
  static constexpr int kPatches = 95;  // x of the border between the model's patches
  int onModel_ = 0;
  int overPatches_ = 0;
};

TEST_F(HatchBorders, NoLineCrossesAnObjectsBorder) {
  EXPECT_EQ(strays(true), 0);
  EXPECT_GT(onModel_, 20);
  EXPECT_GT(strays(false), 100);
}

TEST_F(HatchBorders, NoLineCrossesAPatchsBorder) {
  EXPECT_EQ(strays(true, true), 0);
  EXPECT_GT(onModel_, 20);
  EXPECT_EQ(overPatches_, 0);
  strays(true, false);
  EXPECT_GT(overPatches_, 10) << "one patch has lines across its middle";
}

// Under a zoom, lines go with the image, and those that come and go do so gradually: from frame to
// frame, no width changes by more than the fade's share of it.
TEST_F(HatchLinesTest, UnderAZoomNoLinePops) {
  constexpr double kZoom = 1.02;
  constexpr int kFrames = 14;
  double offPx = 0.0;
  int comes = 0;
  const auto largestStep = [&](const char* fadeSeconds) {
    Hatching style(library_);
    set(style, {{"fade_time", fadeSeconds}, {"directions", "1"}, {"lead", "0"}});
    const float width = 1.7F * static_cast<float>(scaleOf(kSize));
    restart();
    std::vector<StoredLine> before;
    std::vector<marks::Anchor> anchorsBefore;
    double largest = 0.0;
    double off = 0.0;
    int carried = 0;
    comes = 0;
    for (int i = 0; i < kFrames; ++i) {
      scene::ArFrame frame = next(flat(0.2));
      const glm::dvec2 shift = (1.0 - kZoom) * 0.5 * glm::dvec2(kSize.width, kSize.height);
      if (i > 0) {
        motion_.picture->currentFromPrevious =
            glm::dmat3(kZoom, 0, 0, 0, kZoom, 0, shift.x, shift.y, 1);
      }
      style.paint(frame, {});
      const std::vector<StoredLine> lines = storedLines(style.set(0));
      const std::vector<marks::Anchor> anchors = style.set(0).anchors().read();
      for (std::size_t slot = 0; i > 0 && slot < lines.size(); ++slot) {
        const glm::dvec2 from = glm::dvec2(anchors[slot].px) + glm::dvec2(lines[slot].shift);
        // lines that come into the image are there at once
        const double inside = std::min(std::min(from.x, kSize.width - from.x),
                                       std::min(from.y, kSize.height - from.y));
        if (!anchors[slot].isAlive() || inside < 30.0) continue;
        const bool isNew = anchors[slot].isBorn();
        comes += isNew ? 1 : 0;
        const float was = isNew ? 0.0F : before[slot].seen;
        largest = std::max(largest, double{std::abs(lines[slot].seen - was) / (0.5F * width)});
        if (isNew || !anchorsBefore[slot].isAlive()) continue;
        const glm::dvec2 wanted =
            kZoom * (glm::dvec2(anchorsBefore[slot].px) + glm::dvec2(before[slot].shift)) + shift;
        off += glm::distance(from, wanted);
        ++carried;
      }
      before = lines;
      anchorsBefore = anchors;
    }
    offPx = off / std::max(carried, 1);
    return largest;
  };
  constexpr double kStepSeconds = 0.04;  // between frames
  EXPECT_LE(largestStep("1"), 1.2 * kStepSeconds);
  EXPECT_GT(comes, 10);
  EXPECT_LT(offPx, 0.05);
  EXPECT_GT(largestStep("0.1"), 3.0 * kStepSeconds) << "the control";
}

TEST_F(HatchLinesTest, TakeTheImagesColourAsFarAsAsked) {
  hal::Image red = flat(0.5);
  for (int y = 0; y < kSize.height; ++y) {
    auto* p = red.row(0, y).data();
    for (int x = 0; x < kSize.width; ++x, p += 4) {
      p[0] = 180;
      p[1] = 40;
      p[2] = 20;
    }
  }
  for (const double part : {0.0, 0.5, 1.0}) {
    Hatching style(library_);
    set(style, {{"colour", std::to_string(part).c_str()}});
    restart();
    style.paint(next(red), {});
    const HatchingParameters p = hatchingParameters().typed(style.parameters());
    const glm::dvec3 ink(p.inkRed, p.inkGreen, p.inkBlue);
    const glm::dvec3 wanted = glm::mix(ink, glm::dvec3(180, 40, 20) / 255.0, part);
    const std::vector<DrawnLine> lines = drawnLines(style.set(0));
    ASSERT_GT(lines.size(), 20U);
    for (const DrawnLine& line : lines) {
      ASSERT_LT(glm::distance(glm::dvec3(line.paint), wanted), 0.01) << part;
    }
  }
}

}  // namespace
}  // namespace pleinair::styles
