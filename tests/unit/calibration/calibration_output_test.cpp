#include "pipeline/calibration/calibration_output.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/tracking/camera/calibration_file.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/calibration/calibration_views.h"

namespace pleinair::calibration {
namespace {

TEST(CalibrationText, IsReadAsTheSameCamera) {
  const Board board(Checkerboard{9, 6, 0.025});
  const tracking::CameraModel camera(
      {600, 605, 322, 236}, {.k1 = -0.2, .k2 = 0.05, .p1 = 0.003, .p2 = -0.002}, {640, 480});
  CalibrationReport report;
  report.choice = chooseLens(
      idealViews(board, camera, support::calibrationPoses(board, camera), 0.1), {640, 480});
  ASSERT_TRUE(report.choice);
  report.worstPlace = "the upper left corner";
  const std::string text = calibrationText(board, report);
  EXPECT_EQ(text, calibrationText(board, report));
  EXPECT_THAT(text, testing::HasSubstr("# Board: checkerboard of 9x6 inner corners"));
  EXPECT_THAT(text, testing::HasSubstr("# 24 views, 12"));
  EXPECT_THAT(text, testing::HasSubstr("px RMS"));

  const support::TemporaryFolder folder;
  std::ofstream(folder.path() / "camera.toml") << text;
  const tracking::CameraModel read = tracking::loadCalibration(folder.path() / "camera.toml");
  EXPECT_EQ(read.imageSize(), camera.imageSize());
  EXPECT_LT(support::rayErrorPx(report.choice->fit.camera, read), 1e-3);
  EXPECT_NEAR(read.intrinsics().cx, report.choice->fit.camera.intrinsics().cx, 1e-4);
}

}  // namespace
}  // namespace pleinair::calibration
