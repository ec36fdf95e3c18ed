// The finished picture against kept ones. Strokes are interpolated, which other CPUs and drivers
// round otherwise (docs/gpu.md), hence thresholds and no hashes.
#include "tests/golden/golden_picture.h"
#include "tests/golden/still_life.h"
#include "tests/gpu/painterly/painterly_fixture.h"

namespace pleinair::styles {
namespace {

constexpr golden::Likeness kLeast{.psnrDecibels = 32.0, .ssim = 0.95};
class PainterlyGolden : public PainterlyTest {
 protected:
  hal::Image painted(Painterly& style, std::string_view view = {}) {
    return support::readRgba8(style.paint(next(golden::stillLife()), view));
  }
  static std::string compare(const char* name, const hal::Image& picture) {
    return golden::compareWithGolden(
        std::string(PLEINAIR_TESTS_DIR) + "/golden/painterly/" + name + ".png", picture.view(),
        kLeast);
  }
};

TEST_F(PainterlyGolden, StillLife) {
  Painterly style(library_);
  EXPECT_EQ(compare("still_life", painted(style)), "");
}

TEST_F(PainterlyGolden, TheTensorFieldOfTheStillLife) {
  Painterly style(library_);
  EXPECT_EQ(compare("still_life_tensors", painted(style, "tensors")), "");
}

// The comparison itself can fail, on as little as other strokes.
TEST_F(PainterlyGolden, OtherStrokesAreNotAlike) {
  Painterly style(library_);
  const hal::Image one = painted(style);
  style.setParameters(style.parameters().with("seed", "2"));
  const golden::Likeness found = golden::likeness(one.view(), painted(style).view());
  EXPECT_LT(found.psnrDecibels, kLeast.psnrDecibels);
  EXPECT_LT(found.ssim, kLeast.ssim);
}

}  // namespace
}  // namespace pleinair::styles
