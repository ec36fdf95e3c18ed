// Strokes leave out what is of quite another colour: small dark things on light ones stay.
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include <gtest/gtest.h>

#include "tests/gpu/painterly/painterly_fixture.h"

namespace pleinair::styles {
namespace {

using Pixel = std::array<int, 3>;

constexpr hal::FrameSize kPictureSize{192, 144};
constexpr int kApart = 24;  // px between spots
constexpr Pixel kSkin{214, 172, 150};
constexpr Pixel kEye{62, 48, 44};

/// Spots like eyes in a face of 70 px: 7 px wide and 5 px high.
bool isSpot(int x, int y) {
  const int dx = x % kApart - kApart / 2;
  const int dy = y % kApart - kApart / 2;
  return std::hypot(dx / 3.5, dy / 2.5) < 1.0;
}

/// `spotted`: else all is the ground's colour.
hal::Image face(bool spotted) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgb8, .size = kPictureSize, .encoding = {}});
  for (int y = 0; y < kPictureSize.height; ++y) {
    const auto row = image.row(0, y);
    for (int x = 0; x < kPictureSize.width; ++x) {
      const Pixel& pixel = spotted && isSpot(x, y) ? kEye : kSkin;
      for (std::size_t c = 0; c < 3; ++c) {
        row[3 * static_cast<std::size_t>(x) + c] = static_cast<std::uint8_t>(pixel.at(c));
      }
    }
  }
  return image;
}

class ColourClip : public PainterlyTest {
 protected:
  /// The part of the spots' contrast that is left of them in a painting.
  double contrastLeft(const std::string& look, const std::string& clip) {
    Painterly style(library_);
    style.setParameters(
        style.kind().parametersOf(look).with("colour_clip", clip).with("relief", "0"));
    restart();
    std::vector<std::uint8_t> painted;
    for (int i = 0; i < 4; ++i) painted = paint(style, next(face(true)));
    const double shown = meanOf(painted, false) - meanOf(painted, true);
    return shown / (kSkin[1] - kEye[1]);
  }

 private:
  static double meanOf(const std::vector<std::uint8_t>& picture, bool ofSpots) {
    double sum = 0.0;
    int count = 0;
    for (int y = kApart; y < kPictureSize.height - kApart; ++y) {
      for (int x = kApart; x < kPictureSize.width - kApart; ++x) {
        if (isSpot(x, y) != ofSpots) continue;
        sum += picture[static_cast<std::size_t>(4 * (y * kPictureSize.width + x) + 1)];
        ++count;
      }
    }
    return sum / count;
  }
};

TEST_F(ColourClip, KeepsSmallDarkThings) {
  for (const char* const look : {"oil", "impasto", "gouache"}) {
    const double without = contrastLeft(look, "0");
    const double with = contrastLeft(look, "1");
    RecordProperty(look, std::to_string(without) + " and " + std::to_string(with));
    EXPECT_GT(with, 0.4) << look;
    EXPECT_GT(with, 1.4 * without) << look << ", the control";
  }
}

TEST_F(ColourClip, LeavesPaintWhereThePictureIsItsColour) {
  std::vector<std::vector<std::uint8_t>> painted;
  for (const char* const clip : {"0", "1"}) {
    Painterly style(library_);
    style.setParameters(style.parameters().with("colour_clip", clip));
    restart();
    painted.push_back(paint(style, next(face(false))));
  }
  EXPECT_LT(meanDifference(painted[0], painted[1]), 0.5);
}

TEST_F(ColourClip, ComparesLumaWhereThePaletteHasItsOwnHues) {
  // On a blue picture in sepia, all strokes would be of another colour.
  hal::Image blue({.pixelFormat = hal::PixelFormat::kRgb8, .size = kPictureSize, .encoding = {}});
  for (int y = 0; y < kPictureSize.height; ++y) {
    const auto row = blue.row(0, y);
    for (std::size_t i = 0; i < row.size(); ++i) {
      row[i] = static_cast<std::uint8_t>(i % 3 == 2 ? 190 : i % 3 == 1 ? 110 : 60);
    }
  }
  std::vector<std::vector<std::uint8_t>> painted;
  for (const char* const clip : {"0", "1"}) {
    Painterly style(library_);
    style.setParameters(
        style.parameters().with("colour_clip", clip).with("palette", "sepia").with("wash", "0"));
    restart();
    painted.push_back(paint(style, next(blue)));
  }
  EXPECT_LT(meanDifference(painted[0], painted[1]), 6.0);
}

}  // namespace
}  // namespace pleinair::styles
