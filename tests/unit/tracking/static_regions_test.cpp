#include <algorithm>
#include <cstddef>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "tests/support/textured_plane.h"
#include "tests/unit/tracking/motion_watch.h"

namespace pleinair::tracking {
namespace {

using support::currentFromPrevious;
using support::WallView;

constexpr hal::FrameSize kSize{320, 240};

std::size_t countStill(const ImageMotion& motion) {
  return static_cast<std::size_t>(std::ranges::count_if(
      motion.still.errorPx, [](float error) { return error < StaticRegions::kNotStatic; }));
}

TEST(StaticRegionDetector, AStillSceneIsStillForEver) {
  for (const double noise : {0.0, 2.0}) {
    Watch watch({.flow = false});
    watch.view().noiseSigma = noise;
    std::size_t before = 0;
    for (int i = 0; i < 40; ++i) {
      const ImageMotion& motion = watch.step(glm::dmat3(1.0));
      const std::size_t still = countStill(motion);
      EXPECT_GE(still, before) << "frame " << i << ", noise " << noise;
      before = still;
      if (i < 10) continue;
      EXPECT_GT(still, motion.still.errorPx.size() * 9 / 10) << "frame " << i;
      EXPECT_NEAR(motion.noiseLevels, noise, 0.2) << "frame " << i;
    }
  }
}

TEST(StaticRegionDetector, CreepingIsNoticed) {
  Watch watch({.flow = false});
  for (int i = 0; i < 12; ++i) watch.step(glm::dmat3(1.0));
  for (int i = 0; i < 30; ++i) {
    const ImageMotion& motion = watch.step(currentFromPrevious({.shift = {0.05, 0.0}}, kSize));
    if (i < 5) continue;
    EXPECT_LT(countStill(motion), motion.still.errorPx.size() / 10) << i;
  }
}

TEST(StaticRegionDetector, OnlyWhereAThingMovesItIsNotStill) {
  Watch watch;
  const glm::ivec2 corner(96, 64);
  const glm::ivec2 side(96, 80);
  for (int i = 0; i < 16; ++i) {
    const WallView front{.size = kSize,
                         .wallFromFrame = currentFromPrevious({.shift = {1.3 * i, 0.0}}, kSize),
                         .noiseSigma = 2.0,
                         .noiseSeed = watch.view().noiseSeed + 100,
                         .wallSeed = 5};
    const ImageMotion& motion = watch.stepBehind(glm::dmat3(1.0), front, corner, corner + side);
    if (i < 10) continue;
    const hal::FrameSize fields = motion.still.fields;
    for (int f = 0; f < fields.width * fields.height; ++f) {
      const glm::ivec2 px = 16 * glm::ivec2(f % fields.width, f / fields.width);
      const bool isOn = px.x >= corner.x && px.x < corner.x + side.x && px.y >= corner.y &&
                        px.y < corner.y + side.y;
      const bool isStatic =
          motion.still.errorPx[static_cast<std::size_t>(f)] < StaticRegions::kNotStatic;
      EXPECT_FALSE(isOn && isStatic) << i << " at " << px.x << ", " << px.y;
    }
    EXPECT_GT(countStill(motion), 220U) << i;
    // Flow is exactly zero there, too.
    std::size_t zeros = 0;
    for (const glm::vec4& node : motion.flow.forward) {
      zeros += glm::vec2(node) == glm::vec2(0.0F) ? 1U : 0U;
    }
    EXPECT_GT(zeros, motion.flow.forward.size() * 7 / 10) << i;
  }
}

TEST(StaticRegionDetector, IsNotToldOfAPlainWall) {
  Watch watch({.flow = false});
  watch.view().contrast = 0.0;
  for (int i = 0; i < 12; ++i) EXPECT_EQ(countStill(watch.step(glm::dmat3(1.0))), 0U);
}

TEST(StaticRegionDetector, LightMayChange) {
  Watch watch({.flow = false});
  for (int i = 0; i < 12; ++i) watch.step(glm::dmat3(1.0));
  for (int i = 0; i < 10; ++i) {
    watch.view().brightness += 1.0;
    watch.view().contrast *= 0.99;
    const ImageMotion& motion = watch.step(glm::dmat3(1.0));
    EXPECT_GT(countStill(motion), motion.still.errorPx.size() * 9 / 10) << i;
  }
}

}  // namespace
}  // namespace pleinair::tracking
