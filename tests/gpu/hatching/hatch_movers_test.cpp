// Lines where something moves before a camera that stands: the mover has lines of its own, which
// end at its border, and those behind it and beside it stay as they are.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "tests/gpu/hatching/hatching_fixture.h"

namespace pleinair::styles {
namespace {

constexpr glm::dvec2 kDisc{96.0, 72.0};
constexpr double kRadius = 34.0;
constexpr float kOnMover = 4095.0F;  // scene/render/shaders/surface_form.glsl

class HatchMovers : public HatchingTest {
 protected:
  struct Found {
    int onMover = 0;  // drawn lines
    int strays = 0;   // of their points, beyond the mover
    int around = 0;   // lines of the background behind it and beside it
    int changed = 0;  // of these, with another shape than before the mover came
  };
  Found see(const char* movers) {
    Hatching style(library_);
    set(style, {{"movers", movers}, {"directions", "1"}});
    restart();
    const auto look = [&](bool hasDisc) {
      std::mt19937 random(static_cast<unsigned>(number_));
      std::normal_distribution<double> noise(0.0, 2.0 / 255.0);
      const hal::Image image = imageOf(kSize, [&](int x, int y) {
        const bool isDisc = hasDisc && glm::distance(glm::dvec2(x, y), kDisc) < kRadius;
        return (isDisc ? 0.75 + 0.1 * std::sin(0.6 * y) : 0.3 + 0.1 * std::sin(0.6 * x)) +
               noise(random);
      });
      style.paint(next(image), {});
    };
    for (int i = 0; i < 8; ++i) look(false);
    const std::vector<marks::Anchor> anchorsBefore = style.set(0).anchors().read();
    const std::vector<StoredLine> before = storedLines(style.set(0));
    for (int i = 0; i < 4; ++i) look(true);
    const std::vector<marks::Anchor> anchors = style.set(0).anchors().read();
    const std::vector<StoredLine> lines = storedLines(style.set(0));
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

}  // namespace
}  // namespace pleinair::styles
