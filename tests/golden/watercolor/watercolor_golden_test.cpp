// The finished picture against kept ones. Other CPUs and drivers differ by a few 1/255
// (docs/gpu.md), hence thresholds and no hashes.
#include <cmath>

#include "tests/golden/golden_picture.h"
#include "tests/gpu/watercolor/watercolor_fixture.h"

namespace pleinair::styles {
namespace {

constexpr golden::Likeness kLeast{.psnrDecibels = 38.0, .ssim = 0.97};
constexpr hal::FrameSize kSize{320, 240};

/// A still life made by code: a wall in the sun, a table, an orange and a blue jug.
hal::Image stillLife() {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = kSize});
  for (int y = 0; y < kSize.height; ++y) {
    const auto row = image.row(0, y);
    for (int x = 0; x < kSize.width; ++x) {
      const bool table = y > 160 + (x - 160) / 20;
      double light = table ? 0.75 : 1.0 - 0.4 * x / kSize.width;
      double colour[3] = {table ? 150.0 : 235.0, table ? 100.0 : 225.0, table ? 65.0 : 190.0};
      const auto ball = [&](double cx, double cy, double rx, double ry, double r, double g,
                            double b) {
        const double u = (x - cx) / rx;
        const double v = (y - cy) / ry;
        if (u * u + v * v > 1.0) return;
        light =
            0.35 + 0.75 * std::max(0.0, std::sqrt(1.0 - u * u - v * v) * 0.6 - u * 0.5 - v * 0.5);
        colour[0] = r;
        colour[1] = g;
        colour[2] = b;
      };
      ball(225, 130, 45, 70, 60, 90, 170);
      ball(110, 165, 38, 36, 240, 140, 30);
      for (std::size_t c = 0; c < 3; ++c) {
        row[static_cast<std::size_t>(x) * 4 + c] =
            static_cast<std::uint8_t>(std::clamp(colour[c] * light, 0.0, 255.0));
      }
      row[static_cast<std::size_t>(x) * 4 + 3] = 255;
    }
  }
  return image;
}

class WatercolorGolden : public StyleTest {
 protected:
  /// The `count`th frame of a camera that slides over the picture.
  hal::Image painted(std::string_view view, int count, hal::Image (*picture)(int)) {
    Watercolor style(library_);
    hal::Image result;
    for (int i = 0; i < count; ++i) {
      const gpu::Texture texture = support::textureOf(picture(i).view());
      result = support::readRgba8(style.paint(frameOf(texture, i), view));
    }
    return result;
  }
  static std::string compare(const char* name, const hal::Image& picture) {
    return golden::compareWithGolden(
        std::string(PLEINAIR_TESTS_DIR) + "/golden/watercolor/" + name + ".png", picture.view(),
        kLeast);
  }
};

hal::Image stillLifeAt(int /*frame*/) {
  return stillLife();
}
hal::Image movingPattern(int frame) {
  return testPicture(kSize, static_cast<unsigned>(frame), frame * 2.0);
}

TEST_F(WatercolorGolden, StillLife) {
  EXPECT_EQ(compare("still_life", painted("", 1, stillLifeAt)), "");
}

TEST_F(WatercolorGolden, FifthFrameOfAMovingPattern) {
  EXPECT_EQ(compare("moving_pattern", painted("", 5, movingPattern)), "");
}

TEST_F(WatercolorGolden, TheThesissTiling) {
  EXPECT_EQ(compare("still_life_means", painted("means", 1, stillLifeAt)), "");
}

// The comparison itself can fail, on as little as another tiling.
TEST_F(WatercolorGolden, AnotherTilingIsNotAlike) {
  Watercolor style(library_);
  const gpu::Texture texture = support::textureOf(stillLife().view());
  style.setParameters(style.parameters().with("mosaic", "1"));
  const hal::Image one = support::readRgba8(style.paint(frameOf(texture), ""));
  style.setParameters(style.parameters().with("seed", "2"));
  const hal::Image other = support::readRgba8(style.paint(frameOf(texture), ""));
  const golden::Likeness found = golden::likeness(one.view(), other.view());
  EXPECT_LT(found.psnrDecibels, kLeast.psnrDecibels);
  EXPECT_LT(found.ssim, kLeast.ssim);
  EXPECT_EQ(golden::likeness(one.view(), one.view()).ssim, 1.0);
}

}  // namespace
}  // namespace pleinair::styles
