#include <algorithm>

#include <gtest/gtest.h>

#include "pipeline/tracking/motion/image_motion_estimator.h"
#include "tests/support/textured_plane.h"
#include "tests/unit/tracking/motion_watch.h"

namespace pleinair::tracking {
namespace {

using support::currentFromPrevious;

constexpr hal::FrameSize kSize{320, 240};

/// Everything but the features' ids, which go on rising.
void expectSame(const ImageMotion& a, const ImageMotion& b) {
  EXPECT_EQ(a.isCut, b.isCut);
  EXPECT_EQ(a.noiseLevels, b.noiseLevels);
  ASSERT_EQ(a.picture.has_value(), b.picture.has_value());
  if (a.picture) {
    EXPECT_EQ(a.picture->currentFromPrevious, b.picture->currentFromPrevious);
    EXPECT_EQ(a.picture->errorPx, b.picture->errorPx);
  }
  ASSERT_EQ(a.features.size(), b.features.size());
  for (std::size_t i = 0; i < a.features.size(); ++i) {
    EXPECT_EQ(a.features[i].previous, b.features[i].previous) << i;
    EXPECT_EQ(a.features[i].current, b.features[i].current) << i;
    EXPECT_EQ(a.features[i].errorPx, b.features[i].errorPx) << i;
  }
  EXPECT_TRUE(std::ranges::equal(a.still.errorPx, b.still.errorPx));
  EXPECT_TRUE(std::ranges::equal(a.flow.forward, b.flow.forward));
  EXPECT_TRUE(std::ranges::equal(a.flow.backward, b.flow.backward));
}

/// The noise is another one before the cut, and something moves there.
TEST(Cut, LeavesNothingBehind) {
  Watch wentOn;
  wentOn.view().noiseSigma = 6.0;
  for (int i = 0; i < 8; ++i) wentOn.step(currentFromPrevious({.shift = {3.0, 1.0}}, kSize));
  Watch fresh;
  for (Watch* each : {&wentOn, &fresh}) {
    each->view() = {.noiseSigma = 2.0, .noiseSeed = 50, .wallSeed = 9};
  }
  for (int i = 0; i < 12; ++i) {
    SCOPED_TRACE(i);
    const glm::dmat3 step =
        currentFromPrevious({.shift = {i < 6 ? 0.0 : 1.5, 0.0}, .bend = {1e-5, 0.0}}, kSize);
    const ImageMotion& a = wentOn.step(step);
    const ImageMotion& b = fresh.step(step);
    EXPECT_EQ(a.isCut, i == 0);
    expectSame(a, b);
    if (HasFailure()) break;
  }
}

}  // namespace
}  // namespace pleinair::tracking
