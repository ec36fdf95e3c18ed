// Cells where something moves before a camera that stands: the mover has cells of its own, which
// end at its border, and those behind it are the same when it has passed.
#include <cstdint>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/gpu/marks/wall_and_disc.h"
#include "tests/gpu/watercolor/watercolor_fixture.h"
#include "tests/support/gl_test.h"

namespace pleinair::styles {
namespace {

constexpr hal::FrameSize kWall{192, 144};
constexpr double kDiscRadius = 30.0;
constexpr double kPace = 6.0;                  // px a frame
constexpr std::uint32_t kCellBits = 0x3FFFFF;  // shaders/tiling_word.glsl

class WatercolorMovers : public StyleTest {
 protected:
  /// Paints the next frame, with the disc here.
  void look(Watercolor& style, glm::dvec2 disc) {
    const marks::View view{.disc = disc, .radius = kDiscRadius};
    const gpu::Texture picture =
        support::textureOf(marks::seen(view, kWall, static_cast<unsigned>(number_)).view());
    style.paint(followed(picture, number_, {}, motion_), {});
    ++number_;
  }
  /// The slot that each pixel is of.
  static std::vector<std::uint32_t> cellsOf(const Watercolor& style) {
    std::vector<std::uint32_t> cells = support::readR32ui(*style.inner().tiling);
    for (std::uint32_t& word : cells) word &= kCellBits;
    return cells;
  }
  /// The part of the pixels that are of another cell after the disc has passed.
  double changedPart(const char* movers) {
    Watercolor style(library_);
    style.setParameters(style.parameters().with("movers", movers));
    number_ = 0;
    const glm::dvec2 away(-2.0 * kDiscRadius, 72.0);
    for (int i = 0; i < 12; ++i) look(style, away);
    const std::vector<std::uint32_t> before = cellsOf(style);
    for (double x = away.x; x < kWall.width + 2.0 * kDiscRadius; x += kPace)
      look(style, {x, away.y});
    for (int i = 0; i < 12; ++i) look(style, away);
    const std::vector<std::uint32_t> after = cellsOf(style);
    int changed = 0;
    for (std::size_t i = 0; i < after.size(); ++i) changed += after[i] != before[i] ? 1 : 0;
    return static_cast<double>(changed) / static_cast<double>(after.size());
  }

  int number_ = 0;
  tracking::ImageMotion motion_;
};

TEST_F(WatercolorMovers, LeaveTheCellsBehindThemAsTheyWere) {
  EXPECT_LT(changedPart("true"), 0.02);
  EXPECT_GT(changedPart("false"), 0.2) << "the control: movers that are not told apart";
}

TEST_F(WatercolorMovers, HaveCellsOfTheirOwn) {
  Watercolor style(library_);
  glm::dvec2 disc(-2.0 * kDiscRadius, 72.0);
  for (int i = 0; i < 12; ++i) look(style, disc);
  for (; disc.x < 96.0; disc.x += kPace) look(style, disc);
  disc.x -= kPace;  // of the last frame
  const std::vector<std::uint32_t> cells = cellsOf(style);
  const std::vector<marks::Anchor> anchors = style.readAnchors();
  constexpr double kOutline = 4.0;  // px, in which labels may err
  int inside = 0;
  int lost = 0;
  int spilt = 0;
  for (int y = 0; y < kWall.height; ++y) {
    for (int x = 0; x < kWall.width; ++x) {
      const double beyond = glm::distance(glm::dvec2(x, y), disc) - kDiscRadius;
      const std::uint32_t slot = cells[static_cast<std::size_t>(y * kWall.width + x)];
      const bool isMovers = (anchors[slot].state & marks::Anchor::kMover) != 0;
      inside += beyond < -kOutline ? 1 : 0;
      lost += beyond < -kOutline && !isMovers ? 1 : 0;
      spilt += beyond > kOutline && isMovers ? 1 : 0;
    }
  }
  EXPECT_GT(inside, 1500);
  EXPECT_LT(lost, inside / 50);
  EXPECT_LT(spilt, inside / 50);
}

}  // namespace
}  // namespace pleinair::styles
