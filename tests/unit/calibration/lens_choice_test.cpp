#include "pipeline/calibration/lens_choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/calibration/calibration_views.h"

namespace pleinair::calibration {
namespace {

const Board kBoard(Checkerboard{9, 6, 0.025});
constexpr hal::FrameSize kSize{640, 480};

struct Lens {
  tracking::Distortion distortion;
  LensModel model;
};

class LensChoiceOfModel : public testing::TestWithParam<Lens> {};

TEST_P(LensChoiceOfModel, TakesTheTermsThatTheViewsNeed) {
  const tracking::CameraModel camera({450, 450, 322, 238}, GetParam().distortion, kSize);
  const auto choice = chooseLens(
      idealViews(kBoard, camera, support::calibrationPoses(kBoard, camera), 0.08), kSize);
  ASSERT_TRUE(choice);
  EXPECT_EQ(toString(choice->fit.model), toString(GetParam().model));
  EXPECT_LT(support::rayErrorPx(camera, choice->fit.camera), 0.6);
  EXPECT_LT(choice->heldOutRmsPx, 1.1 * choice->fit.rmsPx);
}

INSTANTIATE_TEST_SUITE_P(
    Lenses, LensChoiceOfModel,
    testing::Values(Lens{{}, LensModel::kPinhole}, Lens{{.k1 = -0.08}, LensModel::kK1},
                    Lens{{.k1 = -0.3, .k2 = 0.12}, LensModel::kK1K2},
                    Lens{{.k1 = -0.2, .k2 = 0.05, .p1 = 0.004, .p2 = -0.003}, LensModel::kK1K2P},
                    Lens{{.k1 = -0.3, .k2 = 0.2, .p1 = 0.004, .p2 = -0.003, .k3 = 0.05},
                         LensModel::kK1K2PK3}));

TEST(LensChoice, LeavesOutViewsAndPointsThatDisagree) {
  const tracking::CameraModel camera({450, 450, 322, 238}, {.k1 = -0.1}, kSize);
  auto views = idealViews(kBoard, camera, support::calibrationPoses(kBoard, camera), 0.05);
  // A view in which the board moved while rows were read out, one that took squares for others, and
  // a corner on a speck of dirt.
  for (auto& point : views[3]) point.px.x += 0.05 * point.px.y;
  for (auto& point : views[9]) point.target.x *= 1.3;
  views[5][10].px += glm::dvec2(4.0, -3.0);
  const auto choice = chooseLens(views, kSize);
  ASSERT_TRUE(choice);
  EXPECT_EQ(choice->usedViews.size(), views.size() - 2);
  EXPECT_THAT(choice->usedViews, testing::Not(testing::Contains(3u)));
  EXPECT_THAT(choice->usedViews, testing::Not(testing::Contains(9u)));
  EXPECT_GE(choice->rejectedPoints, 1u);
  EXPECT_LE(choice->rejectedPoints, 3u);
  EXPECT_NEAR(choice->fit.rmsPx, 0.05 * 1.414, 0.01);
  EXPECT_LT(support::rayErrorPx(camera, choice->fit.camera), 0.4);
}

TEST(LensChoice, TakesNothingFromFewViews) {
  const tracking::CameraModel camera({450, 450, 322, 238}, {}, kSize);
  auto views = idealViews(kBoard, camera, support::calibrationPoses(kBoard, camera), 0.05);
  views.resize(kMinFittedViews - 1);
  EXPECT_FALSE(chooseLens(views, kSize));
}

}  // namespace
}  // namespace pleinair::calibration
