// The finished picture against kept ones. Strokes are interpolated, which other CPUs and drivers
// round otherwise (docs/gpu.md), hence thresholds and no hashes.
#include <cmath>

#include "tests/golden/golden_picture.h"
#include "tests/gpu/painterly/painterly_fixture.h"

namespace pleinair::styles {
namespace {

constexpr golden::Likeness kLeast{.psnrDecibels = 32.0, .ssim = 0.95};
constexpr hal::FrameSize kPicture{320, 240};

/// A still life made by code: a wall in the sun, a table, an orange and a blue jug.
hal::Image stillLife() {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = kPicture});
  for (int y = 0; y < kPicture.height; ++y) {
    auto* p = image.row(0, y).data();
    for (int x = 0; x < kPicture.width; ++x, p += 4) {
      const bool table = y > 160 + (x - 160) / 20;
      glm::dvec3 colour = table ? glm::dvec3(150, 100, 65) * 0.75
                                : glm::dvec3(235, 225, 190) * (1.0 - 0.4 * x / kPicture.width);
      const auto ball = [&](glm::dvec2 middle, glm::dvec2 radii, glm::dvec3 own) {
        const glm::dvec2 at = (glm::dvec2(x, y) - middle) / radii;
        const double squared = at.x * at.x + at.y * at.y;
        if (squared > 1.0) return;
        const double lit = std::sqrt(1.0 - squared) * 0.6 - at.x * 0.5 - at.y * 0.5;
        colour = own * (0.35 + 0.75 * std::max(0.0, lit));
      };
      ball({225, 130}, {45, 70}, {60, 90, 170});
      ball({110, 165}, {38, 36}, {240, 140, 30});
      for (int c = 0; c < 3; ++c) {
        p[c] = static_cast<std::uint8_t>(std::clamp(colour[c], 0.0, 255.0));
      }
      p[3] = 255;
    }
  }
  return image;
}

class PainterlyGolden : public PainterlyTest {
 protected:
  hal::Image painted(Painterly& style, std::string_view view = {}) {
    return support::readRgba8(style.paint(next(stillLife()), view));
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
