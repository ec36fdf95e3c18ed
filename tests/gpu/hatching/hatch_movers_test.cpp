// Lines where something moves before a camera that stands: the mover has lines of its own, which
// end at its border, and those behind it and beside it stay as they are.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/packing.hpp>
#include <gmock/gmock.h>

#include "tests/gpu/hatching/hatching_fixture.h"

namespace pleinair::styles {
namespace {

constexpr glm::dvec2 kDisc{96.0, 72.0};
constexpr double kRadius = 34.0;
constexpr float kOnMover = 4095.0F;  // scene/render/shaders/surface_form.glsl

class HatchMovers : public HatchingTest {
 protected:
  /// Vertices of each StripPart.
  using PartVertices = std::array<std::uint32_t, kStripParts>;
  static PartVertices verticesOf(const HatchLines& lines) {
    const auto commands = support::readBuffer<std::uint32_t>(lines.strips().commands);
    return {commands[0], commands[4], commands[8]};
  }

  struct Found {
    int onMover = 0;  // drawn lines
    int strays = 0;   // of their points, beyond the mover
    int around = 0;   // lines of the background behind it and beside it
    int changed = 0;  // of these, with another shape than before the mover came
  };
  /// A set's lines before the disc comes, and four frames after.
  struct Seen {
    std::vector<marks::Anchor> anchorsBefore, anchors;
    std::vector<StoredLine> before, after;
    PartVertices verticesBefore{}, vertices{};
  };
  /// `luma`: of the disc, or of the ground, at a pixel.
  Seen seeDiscCome(Hatching& style, const std::function<double(bool, int, int)>& luma) {
    restart();
    const auto look = [&](bool hasDisc) {
      std::mt19937 random(static_cast<unsigned>(number_));
      std::normal_distribution<double> noise(0.0, 2.0 / 255.0);
      const hal::Image image = imageOf(kSize, [&](int x, int y) {
        const bool isDisc = hasDisc && glm::distance(glm::dvec2(x, y), kDisc) < kRadius;
        return luma(isDisc, x, y) + noise(random);
      });
      style.paint(next(image), {});
    };
    Seen seen;
    for (int i = 0; i < 8; ++i) look(false);
    seen.anchorsBefore = style.set(0).anchors().read();
    seen.before = storedLines(style.set(0));
    seen.verticesBefore = verticesOf(style.set(0));
    for (int i = 0; i < 4; ++i) look(true);
    seen.anchors = style.set(0).anchors().read();
    seen.after = storedLines(style.set(0));
    seen.vertices = verticesOf(style.set(0));
    return seen;
  }
  Found see(const char* movers) {
    Hatching style(library_);
    set(style, {{"movers", movers}, {"directions", "1"}});
    const auto [anchorsBefore, anchors, before, lines, verticesBefore, vertices] =
        seeDiscCome(style, [](bool isDisc, int x, int y) {
          return isDisc ? 0.75 + 0.1 * std::sin(0.6 * y) : 0.3 + 0.1 * std::sin(0.6 * x);
        });
    Found found;
    for (std::size_t slot = 0; slot < lines.size(); ++slot) {
      const double away = glm::distance(glm::dvec2(anchors[slot].px), kDisc) - kRadius;
      const bool isSame = anchorsBefore[slot].isStaying() && anchors[slot].isAlive() &&
                          anchors[slot].seed == anchorsBefore[slot].seed;
      if (!isSame || away > 3.0) continue;
      ++found.around;
      found.changed += lines[slot].ways == before[slot].ways ? 0 : 1;
    }
    const double margin = 3.0 + static_cast<double>(style.set(0).segmentPx());
    for (const DrawnLine& line : drawnLines(style.set(0))) {
      if (line.object != kOnMover) continue;
      ++found.onMover;
      for (const glm::vec2 point : line.points) {
        found.strays += glm::distance(glm::dvec2(point), kDisc) > kRadius + margin ? 1 : 0;
      }
    }
    return found;
  }
};

TEST_F(HatchMovers, HaveLinesOfTheirOwnAndLeaveTheOthersAsTheyAre) {
  const Found told = see("true");
  EXPECT_GT(told.onMover, 8);
  EXPECT_EQ(told.strays, 0);
  EXPECT_GT(told.around, 10);
  EXPECT_EQ(told.changed, 0);
  // The control: movers that are not told from the background change its lines.
  const Found untold = see("false");
  EXPECT_EQ(untold.onMover, 0);
  EXPECT_GT(untold.changed, 5);
}

TEST_F(HatchMovers, ClipLinesOnlyWhileTheyAreThere) {
  Hatching style(library_);
  const Seen seen = seeDiscCome(style, [](bool isDisc, int x, int y) {
    return isDisc ? 0.75 + 0.1 * std::sin(0.6 * y) : 0.3 + 0.1 * std::sin(0.6 * x);
  });
  const auto [plainBefore, clippedBefore, carriedBefore] = seen.verticesBefore;
  EXPECT_GT(plainBefore, 0U);
  EXPECT_EQ(clippedBefore, 0U);
  EXPECT_EQ(carriedBefore, 0U);
  const auto [plain, clipped, carried] = seen.vertices;
  EXPECT_EQ(plain, 0U);
  EXPECT_GT(clipped, 0U);
  EXPECT_GT(carried, 0U);
}

/// Lines of crayon stray from the field, and some lie nearly across it where it has turned: none
/// may swap its ends, nor move.
TEST_F(HatchMovers, LinesOfAStillSceneKeepTheirShape) {
  Hatching style(library_);
  set(style, {{"directions", "2"}, {"lead", "1"}, {"evenness", "0.3"}, {"wander", "0.6"}});
  restart();
  const auto look = [&](double turn) {
    std::mt19937 random(static_cast<unsigned>(number_));
    std::normal_distribution<double> noise(0.0, 2.0 / 255.0);
    style.paint(
        next(imageOf(kSize,
                     [&](int x, int y) {
                       return 0.5 +
                              0.2 * std::sin(0.3 * (x * std::cos(turn) + y * std::sin(turn))) +
                              noise(random);
                     })),
        {});
  };
  look(0.0);
  for (int i = 0; i < 8; ++i) look(1.35);
  for (std::size_t set = 0; set < style.setCount(); ++set) {
    const std::vector<StoredLine> before = storedLines(style.set(set));
    look(1.35);
    const std::vector<StoredLine> after = storedLines(style.set(set));
    const std::vector<marks::Anchor> anchors = style.set(set).anchors().read();
    int compared = 0;
    for (std::size_t slot = 0; slot < after.size(); ++slot) {
      if (!anchors[slot].isStaying()) continue;
      ++compared;
      const glm::vec2 was = glm::unpackSnorm2x16(before[slot].ways[0]);
      const glm::vec2 is = glm::unpackSnorm2x16(after[slot].ways[0]);
      EXPECT_GT(glm::dot(was, is), 0.99F) << slot;
      EXPECT_LT(glm::distance(before[slot].shift, after[slot].shift), 0.1F) << slot;
    }
    EXPECT_GT(compared, 50);
  }
}

/// A plain ground takes its directions from what passes it: its lines are neither turned nor moved.
TEST_F(HatchMovers, DoNotMoveTheLinesBesideThem) {
  const auto farthestMoved = [&](const char* movers, const char* shapeTime) {
    Hatching style(library_);
    set(style,
        {{"movers", movers}, {"directions", "1"}, {"evenness", "0"}, {"shape_time", shapeTime}});
    const auto [anchorsBefore, anchors, before, lines, verticesBefore, vertices] =
        seeDiscCome(style, [](bool isDisc, int, int) { return isDisc ? 0.75 : 0.3; });
    int compared = 0;
    float farthest = 0.0F;
    for (std::size_t slot = 0; slot < lines.size(); ++slot) {
      const double away = glm::distance(glm::dvec2(anchors[slot].px), kDisc) - kRadius;
      const bool isSame = anchorsBefore[slot].isStaying() && anchors[slot].isStaying() &&
                          anchors[slot].seed == anchorsBefore[slot].seed;
      if (!isSame || away < 3.0 || away > 30.0) continue;
      ++compared;
      farthest = std::max(farthest, glm::distance(lines[slot].shift, before[slot].shift));
    }
    EXPECT_GT(compared, 20);
    return farthest;
  };
  EXPECT_LT(farthestMoved("true", "2"), 0.15F);
  EXPECT_GT(farthestMoved("false", "0"), 0.5F) << "the control: lines without memory turn";
}

/// A disc of the ground's luma has no edge of tone: its outline is that of its labels.
TEST_F(HatchMovers, AreOutlinedWhereTheirColourDiffers) {
  const auto inkOnRing = [&](bool hasDisc) {
    Hatching style(library_);
    restart();
    std::vector<std::uint8_t> bytes;
    for (int i = 0; i < 14; ++i) {
      hal::Image image = flat(0.5);
      std::mt19937 random(static_cast<unsigned>(i));
      const double x = 60.0 + 3.0 * i;
      for (int row = 0; row < kSize.height; ++row) {
        std::uint8_t* p = image.row(0, row).data();
        for (int column = 0; column < kSize.width; ++column, p += 4) {
          const auto noise = static_cast<std::uint8_t>(random() % 3U);
          p[0] = p[1] = p[2] = static_cast<std::uint8_t>(128 + noise);
          const bool isDisc =
              hasDisc && i >= 8 && glm::distance(glm::dvec2(column, row), {x, kDisc.y}) < kRadius;
          if (!isDisc) continue;
          p[0] = static_cast<std::uint8_t>(215 + noise);  // 0.2126 R + 0.7152 G: of equal luma
          p[1] = static_cast<std::uint8_t>(102 + noise);
        }
      }
      bytes = paint(style, next(image), "contours");
    }
    int outlined = 0;
    constexpr int kDirections = 64;
    for (int i = 0; i < kDirections; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kDirections;
      int most = 0;
      for (double radius = kRadius - 4.0; radius <= kRadius + 4.0; radius += 0.5) {
        const int column = static_cast<int>(60.0 + 3.0 * 13 + radius * std::cos(angle));
        const int row = static_cast<int>(kDisc.y + radius * std::sin(angle));
        const auto at = static_cast<std::size_t>(row * kSize.width + column) * 4;
        most = std::max(most, 255 - bytes[at]);
      }
      outlined += most > 60 ? 1 : 0;
    }
    return outlined;
  };
  EXPECT_GE(inkOnRing(true), 56);
  EXPECT_EQ(inkOnRing(false), 0) << "the control";
}

/// Lines in the picture's colours (crayon): those of the ground whose middle a mover covers keep
/// the ground's, or they would stick out of the mover in its colour.
TEST_F(HatchMovers, LeaveTheColourOfLinesOfTheGroundBehindThem) {
  const auto paleLines = [&](bool hasDisc) {
    Hatching style(library_);
    set(style, {{"movers", "true"}, {"directions", "1"}, {"colour", "1"}, {"paper_tone", "0"}});
    restart();
    for (int i = 0; i < 14; ++i) {
      std::mt19937 random(static_cast<unsigned>(i));
      std::normal_distribution<double> noise(0.0, 2.0 / 255.0);
      const hal::Image image = imageOf(kSize, [&](int x, int y) {
        const bool isDisc = i >= 8 && glm::distance(glm::dvec2(x, y), kDisc) < kRadius;
        const double ground = hasDisc ? 0.3 + 0.1 * std::sin(0.6 * x) : 0.75;
        return (isDisc ? 0.75 + 0.1 * std::sin(0.6 * y) : ground) + noise(random);
      });
      style.paint(next(image), {});
    }
    // Counts the lines of the ground that lie behind the disc: dark ones, and pale ones.
    std::array<int, 2> counts{};
    for (const DrawnLine& line : drawnLines(style.set(0))) {
      if (line.object == kOnMover) continue;
      const glm::vec2 middle = line.points[line.points.size() / 2];
      if (glm::distance(glm::dvec2(middle), kDisc) > kRadius - 6.0) continue;
      counts.at(line.paint.r > 0.5F ? 1 : 0) += 1;
    }
    return counts;
  };
  const std::array<int, 2> counts = paleLines(true);
  EXPECT_GT(counts[0], 5);
  EXPECT_EQ(counts[1], 0);
  EXPECT_GT(paleLines(false)[1], 0) << "the control: lines of a ground as pale as the disc";
}

/// The lines of each mover are clipped where the other one begins, and not by its own border's
/// labels.
TEST_F(HatchMovers, TwoOfThemAreBothDrawn) {
  constexpr std::array<glm::dvec2, 2> kDiscs{glm::dvec2{36.0, 72.0}, glm::dvec2{156.0, 72.0}};
  constexpr double kSmall = 24.0;
  constexpr double kBorder = 5.0;
  Hatching style(library_);
  set(style, {{"movers", "true"}, {"directions", "1"}});
  restart();
  for (int frame = 0; frame < 14; ++frame) {
    std::mt19937 random(static_cast<unsigned>(frame));
    std::normal_distribution<double> noise(0.0, 2.0 / 255.0);
    const hal::Image image = imageOf(kSize, [&](int x, int y) {
      const bool isDisc = frame >= 8 && std::ranges::any_of(kDiscs, [&](glm::dvec2 disc) {
                            return glm::distance(glm::dvec2(x, y), disc) < kSmall;
                          });
      return (isDisc ? 0.25 + 0.08 * std::sin(0.6 * y) : 0.8 + 0.1 * std::sin(0.6 * x)) +
             noise(random);
    });
    style.paint(next(image), {});
  }
  std::set<float> labels;
  for (const DrawnLine& line : drawnLines(style.set(0))) {
    if (line.object >= 4093.0F && line.object <= kOnMover) labels.insert(line.object);
  }
  EXPECT_EQ(labels.size(), 2U) << "they are to be told from one another";
  const std::vector<std::uint8_t> ink = inkOf(style);
  std::array<double, 2> sums{};
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      for (std::size_t i = 0; i < 2; ++i) {
        if (glm::distance(glm::dvec2(x, y), kDiscs.at(i)) > kSmall - kBorder) continue;
        sums.at(i) += ink[static_cast<std::size_t>(y * kSize.width + x)] / 255.0;
      }
    }
  }
  RecordProperty("ink", std::to_string(sums[0]) + " " + std::to_string(sums[1]));
  EXPECT_GT(std::min(sums[0], sums[1]), 0.6 * std::max(sums[0], sums[1]));
  EXPECT_GT(std::min(sums[0], sums[1]), 100.0);
}

/// Something dark that walks, and swells and shrinks with each step.
class HatchWalker : public HatchingTest {
 protected:
  struct Body {
    double x = 0.0;
    double halfWidth = 0.0;
    bool isAt(int px, int py, double border) const {
      return std::abs(px - x) < halfWidth - border && py > 24.0 + border && py < 120.0 - border;
    }
  };
  static constexpr double kBorder = 4.0;
  static double lumaAt(const Body* body, int x, int y) {
    if (body == nullptr || !body->isAt(x, y, 0.0)) return 0.75 + 0.1 * std::sin(0.6 * x);
    return 0.2 + 0.08 * std::sin(6.0 * (x - body->x) / body->halfWidth) * std::cos(0.3 * y);
  }
  hal::Image imageOf(const Body* body, int seed) const {
    std::mt19937 random(static_cast<unsigned>(seed));
    std::normal_distribution<double> noise(0.0, 2.0 / 255.0);
    return HatchingTest::imageOf(kSize,
                                 [&](int x, int y) { return lumaAt(body, x, y) + noise(random); });
  }
  /// Ink on each third of the body from its trailing side on, in [0, 1].
  static std::array<double, 3> inkOn(const Body& body, const Hatching& style) {
    const std::vector<std::uint8_t> ink = inkOf(style);
    std::array<double, 3> sums{};
    std::array<double, 3> counts{};
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        if (!body.isAt(x, y, kBorder)) continue;
        const double across = 0.5 + 0.5 * (x - body.x) / (body.halfWidth - kBorder);
        const auto third = static_cast<std::size_t>(std::clamp(3.0 * across, 0.0, 2.0));
        sums.at(third) += ink[static_cast<std::size_t>(y * kSize.width + x)] / 255.0;
        counts.at(third) += 1.0;
      }
    }
    for (std::size_t i = 0; i < 3; ++i) sums.at(i) /= std::max(1.0, counts.at(i));
    return sums;
  }
};

TEST_F(HatchWalker, IsDrawnInTheToneThatItWouldHaveIfItStood) {
  Hatching style(library_);
  restart();
  int seed = 0;
  for (int i = 0; i < 10; ++i) style.paint(next(imageOf(nullptr, ++seed)), {});
  std::array<double, 3> walking{};
  std::array<double, 3> standing{};
  constexpr int kSamples = 3;
  Hatching still(library_);
  for (int i = 0; i < 12 + 7 * kSamples; ++i) {
    const Body body{.x = 30.0 + 3.0 * i, .halfWidth = 22.0 + 9.0 * std::sin(0.5 * i)};
    const scene::ArFrame frame = next(imageOf(&body, ++seed));
    style.paint(frame, {});
    if (i < 12 || i % 7 != 0) continue;
    still.reset();
    still.paint(frame, {});
    const std::array<double, 3> now = inkOn(body, style);
    const std::array<double, 3> fresh = inkOn(body, still);
    for (std::size_t third = 0; third < 3; ++third) {
      walking.at(third) += now.at(third) / kSamples;
      standing.at(third) += fresh.at(third) / kSamples;
    }
  }
  for (std::size_t third = 0; third < 3; ++third) {
    RecordProperty("walking" + std::to_string(third), std::to_string(walking.at(third)));
    RecordProperty("standing" + std::to_string(third), std::to_string(standing.at(third)));
    EXPECT_NEAR(walking.at(third), standing.at(third), 0.3 * standing.at(third)) << third;
  }
}

}  // namespace
}  // namespace pleinair::styles
