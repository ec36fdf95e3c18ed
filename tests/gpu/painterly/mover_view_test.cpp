// The debug view of movers: colours by how sure their labels are.
#include <cstdint>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "tests/gpu/painterly/painterly_fixture.h"

namespace pleinair::styles {
namespace {

/// The view's mean colours, in levels, of a dark disc before a grey wall.
class MoverView : public PainterlyTest {
 protected:
  struct Colours {
    glm::dvec3 disc{0.0};
    glm::dvec3 wall{0.0};  ///< far away from it
  };
  Colours see(Painterly& style, double x) {
    constexpr double kDiscRadius = 26.0;
    constexpr std::uint8_t kDiscLevel = 40;
    constexpr std::uint8_t kWallLevel = 150;
    hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = kSize});
    const auto away = [x](int column, int row) {
      return glm::distance(glm::dvec2(column, row), glm::dvec2(x, 72.0)) - kDiscRadius;
    };
    for (int y = 0; y < kSize.height; ++y) {
      auto* p = image.row(0, y).data();
      for (int column = 0; column < kSize.width; ++column, p += 4) {
        p[0] = p[1] = p[2] = away(column, y) < 0.0 ? kDiscLevel : kWallLevel;
        p[3] = 255;
      }
    }
    const std::vector<std::uint8_t> shown = paint(style, next(image), "movers");
    Colours colours;
    double disc = 0.0;
    double wall = 0.0;
    for (int y = 0; y < kSize.height; ++y) {
      for (int column = 0; column < kSize.width; ++column) {
        const std::uint8_t* p = &shown[static_cast<std::size_t>(y * kSize.width + column) * 4];
        const bool isDisc = away(column, y) < -6.0;
        if (!isDisc && away(column, y) < 90.0) continue;
        (isDisc ? colours.disc : colours.wall) += glm::dvec3(p[0], p[1], p[2]);
        (isDisc ? disc : wall) += 1.0;
      }
    }
    colours.disc /= disc;
    colours.wall /= wall;
    return colours;
  }
};

/// A disc that appears and rests: sure after 0.2 s of motion only, and background after 0.7 s.
TEST_F(MoverView, ShowsHowSureTheLabelsAre) {
  constexpr double kUnseen = -200.0;
  constexpr double kSeen = 30.0;
  const auto blueness = [](glm::dvec3 colour) { return colour.b - colour.r; };
  restart();
  Painterly style(library_);
  EXPECT_GT(blueness(see(style, kUnseen).wall), 50.0) << "the background is hardly known";
  Colours last;
  for (int i = 0; i < 12; ++i) last = see(style, kUnseen);
  EXPECT_NEAR(blueness(last.wall), 0.0, 3.0);

  const double young = blueness(see(style, kSeen).disc);
  EXPECT_LT(young, -40.0);
  for (int i = 0; i < 14; ++i) last = see(style, kSeen);
  EXPECT_GT(blueness(last.disc), young + 20.0) << "violet: it rests";
  EXPECT_NEAR(blueness(last.wall), 0.0, 3.0);
  for (int i = 0; i < 20; ++i) last = see(style, kSeen);
  EXPECT_NEAR(blueness(last.disc), 0.0, 3.0) << "it has joined the background";
}

}  // namespace
}  // namespace pleinair::styles
