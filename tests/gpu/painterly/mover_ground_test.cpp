// The ground under a mover: almost all its own colour, and without the paper's grain, until it
// rests; and the light on its paint.
#include <algorithm>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "tests/gpu/painterly/painterly_fixture.h"

namespace pleinair::styles {
namespace {

constexpr double kRadius = 30.0;
constexpr std::uint8_t kDark = 51;
constexpr std::uint8_t kLight = 153;

/// A dark disc that moves before a lighter wall, painted on white paper, with strokes that are not
/// seen unless a test says so.
class MoverGround : public PainterlyTest {
 protected:
  /// Means, in levels: on the disc, within its border, and around it.
  struct Levels {
    double on = 0.0;
    double around = 0.0;
    int largestStep = 0;  ///< of a pixel on the disc, since the frame before
  };

  void begin(Painterly& style, const char* movers, const char* relief = "0",
             const char* opacity = "0") {
    style.setParameters(style.parameters()
                            .with("movers", movers)
                            .with("layers", "1")
                            .with("opacity", opacity)
                            .with("wash", "0.4")
                            .with("tooth", "0.8")
                            .with("support", "paper")
                            .with("relief", relief)
                            .with("gloss", "0")
                            .with("canvas", "0")
                            .with("saturation", "1")
                            .with("warmth", "0")
                            .with("ground_red", "1")
                            .with("ground_green", "1")
                            .with("ground_blue", "1"));
    x_ = 60.0;
    restart();
    for (int i = 0; i < 4; ++i) see(style, false);
  }
  Levels see(Painterly& style, bool hasDisc = true) {
    hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = kSize});
    for (int y = 0; y < kSize.height; ++y) {
      auto* p = image.row(0, y).data();
      for (int x = 0; x < kSize.width; ++x, p += 4) {
        p[0] = p[1] = p[2] = hasDisc && awayOf(x, y) < 0.0 ? kDark : kLight;
        p[3] = 255;
      }
    }
    const std::vector<std::uint8_t> before = std::move(painting_);
    painting_ = paint(style, next(image));
    Levels levels;
    double on = 0.0;
    double around = 0.0;
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        const auto at = static_cast<std::size_t>(y * kSize.width + x) * 4;
        const int level = painting_[at];
        if (awayOf(x, y) < -8.0) {
          levels.on += level;
          on += 1.0;
          const int step = before.empty() ? 0 : std::abs(level - int{before[at]});
          levels.largestStep = std::max(levels.largestStep, step);
        } else if (awayOf(x, y) > 24.0) {
          levels.around += level;
          around += 1.0;
        }
      }
    }
    levels.on /= on;
    levels.around /= around;
    return levels;
  }
  Levels seeItMove(Painterly& style) {
    Levels last;
    for (int i = 0; i < 12; ++i) {
      x_ += 6.0;
      last = see(style);
    }
    return last;
  }

  /// Mean difference of two paintings of the disc at its place, in levels.
  struct Difference {
    double on = 0.0;
    double around = 0.0;
  };
  Difference differenceOf(const std::vector<std::uint8_t>& a,
                          const std::vector<std::uint8_t>& b) const {
    Difference sum;
    double on = 0.0;
    double around = 0.0;
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        const auto at = static_cast<std::size_t>(y * kSize.width + x) * 4;
        const double apart = std::abs(int{a[at]} - int{b[at]});
        const bool isOn = awayOf(x, y) < -8.0;
        if (!isOn && awayOf(x, y) < 24.0) continue;
        (isOn ? sum.on : sum.around) += apart;
        (isOn ? on : around) += 1.0;
      }
    }
    return {.on = sum.on / on, .around = sum.around / around};
  }
  const std::vector<std::uint8_t>& painting() const { return painting_; }

 private:
  double awayOf(int x, int y) const {
    return glm::distance(glm::dvec2(x, y), glm::dvec2(x_, 72.0)) - kRadius;
  }

  double x_ = 0.0;
  std::vector<std::uint8_t> painting_;
};

TEST_F(MoverGround, IsWashedInItsColourWithoutGrain) {
  Painterly style(library_);
  begin(style, "true");
  const Levels told = seeItMove(style);
  // 0.3 of the 0.6 of bare paper is left; grain would leave more.
  EXPECT_NEAR(told.on, 255.0 - (255.0 - kDark) * 0.82, 2.0);
  Painterly untoldStyle(library_);
  begin(untoldStyle, "false");
  const Levels untold = seeItMove(untoldStyle);
  EXPECT_EQ(told.around, untold.around);
  EXPECT_GT(untold.on, told.on + 60.0) << "the control: bare paper";
}

TEST_F(MoverGround, BecomesTheBackgroundsWhileItRests) {
  Painterly style(library_);
  begin(style, "true");
  const double moving = seeItMove(style).on;
  Levels last;
  int largest = 0;
  for (int i = 0; i < 30; ++i) {  // 1.2 s
    last = see(style);
    largest = std::max(largest, last.largestStep);
  }
  Painterly untold(library_);
  begin(untold, "false");
  seeItMove(untold);
  EXPECT_NEAR(last.on, see(untold).on, 1.0);
  EXPECT_GT(last.on, moving + 60.0);
  EXPECT_LT(largest, 45) << "at once";
}

TEST_F(MoverGround, ThickPaintOnItIsLitLikeThinPaint) {
  std::vector<std::vector<std::uint8_t>> paintings;
  for (const char* relief : {"1.5", "2.6"}) {
    Painterly style(library_);
    begin(style, "true", relief, "1");
    seeItMove(style);
    paintings.push_back(painting());
  }
  const Difference thick = differenceOf(paintings[0], paintings[1]);
  EXPECT_LT(thick.on, 0.1);
  EXPECT_GT(thick.around, 1.0) << "the control: the wall's paint is lit as it is thick";
  Painterly flat(library_);
  begin(flat, "true", "0", "1");
  seeItMove(flat);
  EXPECT_GT(differenceOf(paintings[0], painting()).on, 0.3) << "nor is it flat";
}

}  // namespace
}  // namespace pleinair::styles
