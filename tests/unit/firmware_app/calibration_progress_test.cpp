#include "firmware_app/offline/calibration_progress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/board_scene.h"

namespace pleinair::app {
namespace {

using calibration::ViewOutcome;
using testing::HasSubstr;

TEST(CalibrationProgress, ShowsCoverageAndWhatToDoNext) {
  const calibration::Board board(calibration::Checkerboard{9, 6, 0.025});
  const tracking::CameraModel camera({600, 600, 320, 240}, {}, {640, 480});
  calibration::ViewSelector selector(board, camera.imageSize());
  selector.offer(0, hal::TimePoint(), std::nullopt);
  EXPECT_THAT(coveragePanel(selector, ViewOutcome::kNoBoard)[5],
              HasSubstr("next: show the whole board"));

  // In the lower left quarter, still.
  const auto pose = support::cameraFromBoard(board, camera, {.at = {0.25, 0.75}, .span = 0.4});
  for (int i = 1; i <= 2; ++i) {
    selector.offer(static_cast<std::uint64_t>(i), hal::TimePoint(std::chrono::milliseconds(33 * i)),
                   support::idealSighting(board, camera, pose, 0.02));
  }
  const std::vector<std::string> panel = coveragePanel(selector, ViewOutcome::kTaken);
  ASSERT_EQ(panel.size(), 6u);
  EXPECT_THAT(panel[0], testing::StartsWith(". . . . . . . . "));
  EXPECT_THAT(panel[0], HasSubstr("1 view; the board in 2 of 3 pictures"));
  EXPECT_THAT(panel[4], testing::StartsWith("o o o o . . . . "));
  EXPECT_THAT(panel[4], HasSubstr("now:  taken"));
  EXPECT_THAT(panel[5], HasSubstr("next: tilt the board so that its left side is nearer"));
}

}  // namespace
}  // namespace pleinair::app
