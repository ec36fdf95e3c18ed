// Narrow things stay to be seen under strokes that are as broad.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/gpu/painterly/painterly_fixture.h"

namespace pleinair::styles {
namespace {

constexpr hal::FrameSize kLarge{640, 480};
constexpr std::uint8_t kWall = 190;
constexpr std::uint8_t kWire = 30;

/// A mast of 3 px that leans to the right going up, on a plain wall.
bool isOnMast(int x, int y) {
  return y > 100 && y < 380 && std::abs(x + 0.2 * y - 380.0) < 1.5;
}

hal::Image mastPicture() {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = kLarge});
  for (int y = 0; y < kLarge.height; ++y) {
    auto* p = image.row(0, y).data();
    for (int x = 0; x < kLarge.width; ++x, p += 4) {
      p[0] = p[1] = p[2] = isOnMast(x, y) ? kWire : kWall;
      p[3] = 255;
    }
  }
  return image;
}

class Accents : public PainterlyTest {
 protected:
  /// The part of the mast's contrast that the painting has.
  double contrastKept(const char* accents) {
    Painterly style(library_);
    style.setParameters(
        style.parameters().with("accents", accents).with("relief", "0").with("canvas", "0"));
    restart();
    const std::vector<std::uint8_t> painted = paint(style, next(mastPicture()));
    double mast = 0.0;
    double wall = 0.0;
    int pixels = 0;
    for (int y = 110; y < 370; ++y) {
      for (int x = 40; x < kLarge.width - 40; ++x) {
        if (!isOnMast(x, y)) continue;
        const auto green = [&](int at) {
          return static_cast<double>(
              painted[static_cast<std::size_t>(4 * (y * kLarge.width + at) + 1)]);
        };
        mast += green(x);
        wall += 0.5 * (green(x - 30) + green(x + 30));
        ++pixels;
      }
    }
    return (wall - mast) / pixels / (kWall - kWire);
  }
};

TEST_F(Accents, KeepAMastThatIsNarrowerThanTheFinestStrokes) {
  const double with = contrastKept("true");
  const double without = contrastKept("false");
  RecordProperty("with", std::to_string(with));
  RecordProperty("without", std::to_string(without));
  EXPECT_GT(with, 0.62);
  EXPECT_LT(without, 0.55) << "the control";
}

}  // namespace
}  // namespace pleinair::styles
