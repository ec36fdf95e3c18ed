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

}  // namespace
}  // namespace pleinair::inspection
