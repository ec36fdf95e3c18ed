#include "pipeline/gpu/images/aspect_fill.h"

#include <array>

#include <gtest/gtest.h>

namespace pleinair::gpu {
namespace {

void expectFit(const AspectFill& fit, double scale, glm::dvec2 origin) {
  EXPECT_DOUBLE_EQ(fit.scale.x, scale);
  EXPECT_DOUBLE_EQ(fit.scale.y, scale);
  EXPECT_DOUBLE_EQ(fit.origin.x, origin.x);
  EXPECT_DOUBLE_EQ(fit.origin.y, origin.y);
}

TEST(AspectFill, IsTheIdentityForOneSize) {
  expectFit(aspectFill({640, 480}, {640, 480}), 1.0, {0.0, 0.0});
}

TEST(AspectFill, ScalesAlikeBothWaysForOneAspect) {
  expectFit(aspectFill({1280, 720}, {640, 360}), 2.0, {0.0, 0.0});
  expectFit(aspectFill({320, 240}, {640, 480}), 0.5, {0.0, 0.0});
}

TEST(AspectFill, CutsTheSidesOfAWiderPictureAndTopAndBottomOfATallerOne) {
  expectFit(aspectFill({1280, 720}, {640, 480}), 1.5, {160.0, 0.0});
  expectFit(aspectFill({640, 480}, {1280, 720}), 0.5, {0.0, 60.0});
}

TEST(AspectFill, StaysWithinThePictureAndTouchesTwoBorders) {
  constexpr std::array<hal::FrameSize, 5> kSizes{{{1, 1}, {7, 5}, {640, 480}, {1, 900}, {8192, 3}}};
  for (const hal::FrameSize source : kSizes) {
    for (const hal::FrameSize target : kSizes) {
      const AspectFill fit = aspectFill(source, target);
      const glm::dvec2 end = fit.origin + fit.scale * glm::dvec2(target.width, target.height);
      EXPECT_GE(fit.origin.x, -1e-9);
      EXPECT_GE(fit.origin.y, -1e-9);
      EXPECT_NEAR(fit.origin.x, source.width - end.x, 1e-9);  // centred
      EXPECT_NEAR(fit.origin.y, source.height - end.y, 1e-9);
      EXPECT_NEAR(std::min(fit.origin.x, fit.origin.y), 0.0, 1e-9);
    }
  }
}

}  // namespace
}  // namespace pleinair::gpu
