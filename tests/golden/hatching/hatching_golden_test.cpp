// The finished drawing against kept ones, with thresholds as for painterly: lines are interpolated,
// which other CPUs and drivers round otherwise (docs/gpu.md).
#include "pipeline/styles/hatching/hatching.h"
#include "tests/golden/golden_picture.h"
#include "tests/golden/still_life.h"
#include "tests/gpu/painterly/painterly_fixture.h"

namespace pleinair::styles {
namespace {

constexpr golden::Likeness kLeast{.psnrDecibels = 28.0, .ssim = 0.95};

class HatchingGolden : public PainterlyTest {
 protected:
  hal::Image drawn(Hatching& style, std::string_view look, std::string_view view = {}) {
    style.setParameters(style.kind().parametersOf(look));
    return support::readRgba8(style.paint(next(golden::stillLife()), view));
  }
  static std::string compare(const char* name, const hal::Image& picture) {
    return golden::compareWithGolden(
        std::string(PLEINAIR_TESTS_DIR) + "/golden/hatching/" + name + ".png", picture.view(),
        kLeast);
  }
};

TEST_F(HatchingGolden, StillLifeByPen) {
  Hatching style(library_);
  EXPECT_EQ(compare("still_life_pen", drawn(style, "pen")), "");
}

TEST_F(HatchingGolden, StillLifeEngraved) {
  Hatching style(library_);
  EXPECT_EQ(compare("still_life_engraving", drawn(style, "engraving")), "");
}

TEST_F(HatchingGolden, ContoursOfTheStillLife) {
  Hatching style(library_);
  EXPECT_EQ(compare("still_life_contours", drawn(style, "pen", "contours")), "");
}

// The comparison itself can fail, on as little as other lines.
TEST_F(HatchingGolden, OtherLinesAreNotAlike) {
  Hatching style(library_);
  const hal::Image one = drawn(style, "pen");
  style.setParameters(style.parameters().with("seed", "2"));
  const hal::Image other = support::readRgba8(style.paint(next(golden::stillLife()), {}));
  const golden::Likeness found = golden::likeness(one.view(), other.view());
  EXPECT_LT(found.psnrDecibels, kLeast.psnrDecibels);
  EXPECT_LT(found.ssim, kLeast.ssim);
}

}  // namespace
}  // namespace pleinair::styles
