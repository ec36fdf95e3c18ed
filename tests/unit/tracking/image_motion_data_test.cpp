#include <gtest/gtest.h>

#include "tests/reports/tracking/motion_measures.h"
#include "tests/reports/tracking/pose_measures.h"
#include "tests/reports/tracking/truth_sequence.h"
#include "tests/unit/tracking/desk_sequence.h"

namespace pleinair::tracking {
namespace {

constexpr std::size_t kFrames = 40;

void expectCalibrated(const Errors& errors) {
  EXPECT_GT(errors.ratio(), 0.5);
  EXPECT_LT(errors.ratio(), 2.0);
}

/// Flow that follows the dominant motion is more accurate than its texture allows.
void expectCautious(const Errors& errors) {
  EXPECT_GT(errors.ratio(), 0.15);
  EXPECT_LT(errors.ratio(), 1.5);
}

TEST(ImageMotionOnData, FollowsAPhotographUnderHandShake) {
  if (!hasVirtualCamera()) GTEST_SKIP() << "no sequence virtual_camera in " PLEINAIR_SHARED_DATA;
  const MotionResult found = measureMotion(virtualCameraMotion(kFrames), {});
  EXPECT_EQ(found.cuts, 0U);
  EXPECT_EQ(found.pictures, found.frames);
  EXPECT_LT(percentile(found.features.actual, 0.5), 0.13);
  EXPECT_LT(percentile(found.features.actual, 0.95), 0.6);
  EXPECT_LT(percentile(found.picture.actual, 0.95), 0.1);
  EXPECT_LT(percentile(found.flow.actual, 0.5), 0.25);
  expectCalibrated(found.features);
  expectCalibrated(found.picture);
  expectCautious(found.flow);
}

TEST(ImageMotionOnData, FollowsADeskInMotionBlur) {
  if (!hasDeskSequence()) GTEST_SKIP() << "no sequence desk_6dof in " PLEINAIR_SHARED_DATA;
  const MotionResult found = measureMotion(deskMotion(kFrames), {});
  EXPECT_EQ(found.cuts, 0U);
  EXPECT_EQ(found.pictures, found.frames);
  EXPECT_LT(percentile(found.features.actual, 0.5), 0.18);
  EXPECT_LT(percentile(found.picture.actual, 0.95), 0.18);
  EXPECT_LT(percentile(found.flow.actual, 0.5), 0.25);
  expectCalibrated(found.features);
  expectCalibrated(found.picture);
  expectCautious(found.flow);
}

TEST(ImageMotionOnData, FollowsLayersThatMoveApart) {
  if (!hasLayers()) GTEST_SKIP() << "no flow/synth_layers in " PLEINAIR_SHARED_DATA;
  const MotionResult found = measureMotion(layersMotion(), {});
  EXPECT_EQ(found.cuts, 0U);
  EXPECT_LT(percentile(found.features.actual, 0.5), 0.05);
  EXPECT_LT(percentile(found.flow.actual, 0.5), 0.06);
  EXPECT_LT(percentile(found.flow.surest(0.9).actual, 0.95), 0.3);
  expectCalibrated(found.features);
  expectCautious(found.flow);
}

/// The thesis's tracker finds the same motion, less exactly.
TEST(ImageMotionOnData, TheReferenceTrackerAgrees) {
  if (!hasDeskSequence()) GTEST_SKIP() << "no sequence desk_6dof in " PLEINAIR_SHARED_DATA;
  const MotionResult found =
      measureMotion(deskMotion(15), {.features = FeatureMethod::kHarrisSift, .flow = false});
  EXPECT_EQ(found.cuts, 0U);
  EXPECT_GT(found.featuresPerFrame, 50.0);
  EXPECT_LT(percentile(found.features.actual, 0.5), 0.5);
  EXPECT_LT(percentile(found.picture.actual, 0.5), 0.5);
}

}  // namespace
}  // namespace pleinair::tracking
