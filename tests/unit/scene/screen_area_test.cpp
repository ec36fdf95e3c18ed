#include "pipeline/scene/render/screen_area.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace pleinair::scene {
namespace {

const tracking::CameraModel kPlain({.fx = 500, .fy = 510, .cx = 320, .cy = 240}, {}, {640, 480});
const tracking::CameraModel kBarrel({.fx = 500, .fy = 510, .cx = 320, .cy = 240},
                                    {.k1 = -0.28, .k2 = 0.06}, {640, 480});

bool contains(const ScreenArea& area, glm::dvec2 px) {
  const glm::dvec2 low(area.origin);
  const glm::dvec2 high(area.origin + area.size);
  return px.x >= low.x && px.y >= low.y && px.x <= high.x && px.y <= high.y;
}

TEST(ScreenArea, HoldsABallAndLittleMore) {
  for (const auto* camera : {&kPlain, &kBarrel}) {
    for (const glm::dvec3 centre : {glm::dvec3(0.0, 0.0, 1.0), glm::dvec3(0.4, -0.3, 1.2),
                                    glm::dvec3(-0.25, 0.2, 0.5), glm::dvec3(1.0, 0.0, 1.5)}) {
      const BoundingSphere ball{centre, 0.12};
      const ScreenArea area = areaAround(ball, *camera);
      glm::dvec2 low(HUGE_VAL);
      glm::dvec2 high(-HUGE_VAL);
      for (int i = 0; i < 5000; ++i) {
        const double z = 1.0 - 2.0 * (i + 0.5) / 5000.0;
        const double radius = std::sqrt(1.0 - z * z);
        const glm::dvec3 on = centre + 0.12 * glm::dvec3(radius * std::cos(2.39996 * i),
                                                         radius * std::sin(2.39996 * i), z);
        const glm::dvec2 px = camera->project(on);
        if (px.x < 0.0 || px.y < 0.0 || px.x > 640.0 || px.y > 480.0) continue;
        low = glm::min(low, px);
        high = glm::max(high, px);
        ASSERT_TRUE(contains(area, px)) << px.x << ',' << px.y;
      }
      const glm::dvec2 seen = high - low;
      EXPECT_LT(area.size.x, 1.45 * seen.x + 8.0);
      EXPECT_LT(area.size.y, 1.45 * seen.y + 8.0);
    }
  }
}

TEST(ScreenArea, IsThePictureForWhatReachesTheCamera) {
  for (const BoundingSphere& ball :
       {BoundingSphere{{0.0, 0.0, 0.1}, 0.2}, BoundingSphere{{2.0, 0.0, 0.3}, 0.25}}) {
    const ScreenArea area = areaAround(ball, kPlain);
    EXPECT_EQ(area.size, glm::ivec2(640, 480));
  }
}

TEST(ScreenArea, IsEmptyOutsideThePicture) {
  EXPECT_TRUE(areaAround(BoundingSphere{{3.0, 0.0, 2.0}, 0.1}, kPlain).isEmpty());
}

TEST(ScreenArea, UnitesWithNothing) {
  const ScreenArea a{{10, 20}, {30, 40}};
  EXPECT_EQ(unionOf(a, {}).size, a.size);
  EXPECT_EQ(unionOf({}, a).origin, a.origin);
  const ScreenArea both = unionOf(a, {{0, 50}, {5, 100}});
  EXPECT_EQ(both.origin, glm::ivec2(0, 20));
  EXPECT_EQ(both.size, glm::ivec2(40, 130));
}

}  // namespace
}  // namespace pleinair::scene
