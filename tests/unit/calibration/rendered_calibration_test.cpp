// Detects boards rendered through known lenses, and fits and chooses the lens.
#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/calibration/session.h"
#include "tests/support/board_scene.h"

namespace pleinair::calibration {
namespace {

struct Case {
  const char* name;
  Board board;
  tracking::CameraModel camera;
  double largestRayErrorPx;
};

void PrintTo(const Case& each, std::ostream* stream) {
  *stream << each.name;
}

class RenderedCalibration : public testing::TestWithParam<Case> {};

TEST_P(RenderedCalibration, FindsTheLens) {
  const auto& [name, board, camera, largestRayErrorPx] = GetParam();
  const support::BoardRenderer renderer(board, camera);
  CalibrationSession session(board, camera.imageSize(), {.selection = {.isSequence = false}});
  std::uint32_t frame = 0;
  for (const support::BoardHold& hold : support::calibrationPoses(board, camera)) {
    const hal::Image picture = renderer.render(
        support::cameraFromBoard(board, camera, hold),
        {.samplesPerSide = 3, .blurSigmaPx = 0.6, .noiseSigma = 2.0, .noiseSeed = frame + 1});
    session.offer(picture.view(), hal::TimePoint(std::chrono::seconds(++frame)));
  }
  const CalibrationReport report = session.solve();
  ASSERT_TRUE(report.isGood()) << report.refusals.front().text;
  const tracking::Intrinsics& found = report.choice->fit.camera.intrinsics();
  const tracking::Intrinsics& wanted = camera.intrinsics();
  EXPECT_NEAR(found.fx / wanted.fx, 1.0, 0.002);
  EXPECT_NEAR(found.fy / wanted.fy, 1.0, 0.002);
  EXPECT_NEAR(found.cx, wanted.cx, 0.0008 * camera.imageSize().width);
  EXPECT_NEAR(found.cy, wanted.cy, 0.0008 * camera.imageSize().width);
  const double error = support::rayErrorPx(camera, report.choice->fit.camera);
  EXPECT_LT(error, largestRayErrorPx);
  EXPECT_LT(error, 3.5 * report.worstSigmaPx);  // the predicted error holds
  EXPECT_LT(report.choice->fit.rmsPx, 0.15);
  RecordProperty("ray_error_px", std::to_string(error));
  RecordProperty("views", static_cast<int>(report.choice->used.size()));
}

const Board kCheckerboard(Checkerboard{9, 6, 0.025});
const Board kGrid(AprilGrid{6, 6, 0.03, 0.3, 0});

INSTANTIATE_TEST_SUITE_P(
    Lenses, RenderedCalibration,
    testing::Values(Case{"CheckerboardWithoutDistortion",
                         kCheckerboard,
                         {{600, 600, 320, 240}, {}, {640, 480}},
                         0.3},
                    Case{"CheckerboardBarrel",
                         kCheckerboard,
                         {{420, 422, 325.3, 236.2}, {.k1 = -0.3, .k2 = 0.09}, {640, 480}},
                         0.3},
                    Case{"CheckerboardTangentialHd",
                         kCheckerboard,
                         {{900, 905, 650, 352},
                          {.k1 = -0.12, .k2 = 0.03, .p1 = 0.0015, .p2 = -0.001},
                          {1280, 720}},
                         0.3},
                    Case{"AprilGridBarrel",
                         kGrid,
                         {{420, 422, 325.3, 236.2}, {.k1 = -0.3, .k2 = 0.09}, {640, 480}},
                         0.3},
                    Case{"AprilGridTangentialHd",
                         kGrid,
                         {{900, 905, 650, 352},
                          {.k1 = -0.12, .k2 = 0.03, .p1 = 0.0015, .p2 = -0.001},
                          {1280, 720}},
                         0.3}),
    [](const auto& each) { return each.param.name; });

}  // namespace
}  // namespace pleinair::calibration
