#include "pipeline/inspection/part_window.h"

#include <cmath>

#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "tests/unit/inspection/plane_pictures.h"

namespace pleinair::inspection {
namespace {

TEST(PartWindow, PicturesFromOtherPlacesLieOnOneAnother) {
  const glm::dmat4 first = lookingFrom(0);
  const PartWindow window = windowAbout({0.01, -0.005, 0}, 0.05, first);
  const hal::Image a = planeSeen(first);
  const WindowPicture expected = windowPicture(window, {a.view(), camera(), first});
  EXPECT_EQ(expected.shareInside, 1.0);
  EXPECT_NEAR(expected.halfPx, 40, 2);
  for (const glm::dmat4& other : {lookingFrom(10), lookingFrom(-8, 20)}) {
    const hal::Image b = planeSeen(other);
    const WindowPicture seen = windowPicture(window, {b.view(), camera(), other});
    double sum = 0.0;
    for (int y = 0; y < kWindowPx; ++y) {
      for (int x = 0; x < kWindowPx; ++x) {
        const auto at = static_cast<std::size_t>(x);
        sum +=
            std::abs(int{seen.luma.view().row(0, y)[at]} - int{expected.luma.view().row(0, y)[at]});
      }
    }
    EXPECT_LT(sum / (kWindowPx * kWindowPx), 2.5) << "grey levels";
  }
}

TEST(PartWindow, SaysWhatIsBesideThePicture) {
  const glm::dmat4 first = lookingFrom(0);
  const hal::Image a = planeSeen(first);
  const PartWindow window = windowAbout({0.2, 0, 0}, 0.05, first);
  EXPECT_LT(windowPicture(window, {a.view(), camera(), first}).shareInside, 0.6);
}

TEST(PartWindow, KnowsTheAngleBetweenTwoViews) {
  EXPECT_NEAR(glm::degrees(viewAngleRad({}, lookingFrom(3), lookingFrom(-8, 30))), 11.0, 1e-6);
}

TEST(PartRelief, IsTheNearestSurfaceAndItsPart) {
  const glm::dmat4 front = lookingFrom(0);
  const PartWindow window = windowAbout({}, 0.05, front);
  const auto square = [](double z, double half, std::size_t part) {
    return PartTriangle{{{{-half, -half, z}, {3 * half, -half, z}, {-half, 3 * half, z}}}, part};
  };
  // The camera is at negative z.
  const std::vector<PartTriangle> triangles{square(0.0, 0.04, 7), square(-0.02, 0.01, 8)};
  const std::vector<ReliefPixel> relief = windowRelief(window, front, triangles);
  const ReliefPixel& middle = relief[80 * kWindowPx + 80];
  EXPECT_EQ(middle.part, 8);
  EXPECT_NEAR(middle.height, 0.4, 1e-5);
  const ReliefPixel& aside = relief[80 * kWindowPx + 50];
  EXPECT_EQ(aside.part, 7);
  EXPECT_NEAR(aside.height, 0.0, 1e-5);
  EXPECT_TRUE(std::isnan(relief[80 * kWindowPx + 5].height)) << "beside both";
}

TEST(PartRelief, MovesAgainstTheCamera) {
  const glm::dmat4 front = lookingFrom(0);
  const PartWindow window = windowAbout({}, 0.05, front);
  EXPECT_NEAR(glm::length(reliefShiftPx(window, front, front)), 0.0, 1e-9);
  const glm::dvec2 shift = reliefShiftPx(window, front, lookingFrom(6));
  // What a window's pixel shows of a point at that height, by the pictures' own mapping.
  EXPECT_NEAR(glm::length(shift), 80.0 * std::tan(glm::radians(6.0)), 1.5);
  EXPECT_NEAR(shift.y, 0.0, 1e-6);
  EXPECT_NEAR(reliefShiftPx(window, front, lookingFrom(-6)).x, -shift.x, 1e-6);
}

}  // namespace
}  // namespace pleinair::inspection
