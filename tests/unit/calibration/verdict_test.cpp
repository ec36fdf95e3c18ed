#include "pipeline/calibration/verdict.h"

#include <algorithm>
#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/calibration/calibration_views.h"

namespace pleinair::calibration {
namespace {

using support::BoardHold;
using testing::Contains;
using testing::HasSubstr;

const Board kBoard(Checkerboard{9, 6, 0.025});
const tracking::CameraModel kCamera({600, 600, 320, 240}, {.k1 = -0.1}, {640, 480});

struct Showing {
  double noisePx = 0.08;
  double edgeWidthPx = 1.5;
  double stretchX = 1.0;
  double skew = 0.0;  ///< shift per row of a view, in px, different in each view
};

/// Like photographs, one per hold.
ViewSelector shown(const std::vector<BoardHold>& tour, const Showing& how = {}) {
  ViewSelector selector(kBoard, kCamera.imageSize(), {.isSequence = false});
  std::uint32_t frame = 0;
  for (const BoardHold& hold : tour) {
    glm::dmat4 pose = support::cameraFromBoard(kBoard, kCamera, hold);
    pose[0] *= how.stretchX;
    BoardSighting sighting = support::idealSighting(kBoard, kCamera, pose, how.noisePx, ++frame);
    sighting.edgeWidthPx = how.edgeWidthPx;
    const double skew = how.skew * ((frame * 7) % 5 - 2.0);
    for (SightedCorner& corner : sighting.corners) corner.px.x += skew * corner.px.y;
    if (sighting.corners.size() < kBoard.corners().size()) continue;
    selector.offer(frame, hal::TimePoint(std::chrono::seconds(frame)), std::move(sighting));
  }
  return selector;
}

std::vector<RefusalReason> reasonsOf(const CalibrationReport& report) {
  std::vector<RefusalReason> reasons;
  for (const Refusal& refusal : report.refusals) {
    EXPECT_FALSE(refusal.text.empty() || refusal.remedy.empty());
    reasons.push_back(refusal.reason);
  }
  return reasons;
}

CalibrationReport judged(const std::vector<BoardHold>& tour, const Showing& how = {}) {
  return solveCalibration(shown(tour, how), kCamera.imageSize());
}

TEST(Verdict, AGoodTourIsGood) {
  const CalibrationReport report = judged(support::calibrationPoses(kBoard, kCamera));
  ASSERT_TRUE(report.isGood()) << report.refusals.front().text;
  EXPECT_LT(report.worstSigmaPx, 0.5);
  EXPECT_LE(report.typicalSigmaPx, report.worstSigmaPx);
  EXPECT_FALSE(report.worstPlace.empty());
}

TEST(Verdict, RefusesFrontalViews) {
  const CalibrationReport report = judged(frontalTour());
  EXPECT_THAT(reasonsOf(report), Contains(RefusalReason::kSameAngle));
  EXPECT_FALSE(report.isGood());
}

TEST(Verdict, RefusesViewsOfTheMiddleOnly) {
  std::vector<BoardHold> tour;
  for (const double yaw : {-0.6, -0.3, 0.0, 0.3, 0.6}) {
    for (const double pitch : {-0.5, 0.0, 0.5}) {
      tour.push_back({.span = 0.35, .yaw = yaw, .pitch = pitch, .roll = yaw * pitch});
    }
  }
  const CalibrationReport report = judged(tour);
  ASSERT_THAT(reasonsOf(report), Contains(RefusalReason::kCoverage));
  std::string texts;
  for (const Refusal& refusal : report.refusals) texts += refusal.text + "; ";
  EXPECT_THAT(texts, HasSubstr("the upper left corner, the upper right corner"));
}

TEST(Verdict, NamesTheRegionThatIsMissing) {
  std::vector<BoardHold> tour = support::calibrationPoses(kBoard, kCamera);
  std::erase_if(tour, [](const BoardHold& hold) {
    const auto pose = support::cameraFromBoard(kBoard, kCamera, hold);
    const BoardSighting sighting = support::idealSighting(kBoard, kCamera, pose);
    return std::ranges::any_of(sighting.corners, [](const SightedCorner& corner) {
      return corner.px.x > 0.62 * 640 && corner.px.y < 0.34 * 480;
    });
  });
  const CalibrationReport report = judged(tour);
  ASSERT_THAT(reasonsOf(report), Contains(RefusalReason::kCoverage));
  EXPECT_THAT(report.refusals.front().text, HasSubstr("the upper right corner"));
}

TEST(Verdict, RefusesFewViews) {
  std::vector<BoardHold> tour = support::calibrationPoses(kBoard, kCamera);
  tour.resize(5);
  const CalibrationReport report = judged(tour);
  EXPECT_THAT(reasonsOf(report), testing::ElementsAre(RefusalReason::kTooFewViews));
  EXPECT_THAT(report.refusals.front().text, HasSubstr("only 5 of 5 pictures"));
}

TEST(Verdict, SaysThatThereIsNoBoard) {
  ViewSelector selector(kBoard, kCamera.imageSize());
  for (int i = 0; i < 30; ++i) selector.offer(0, hal::TimePoint(), std::nullopt);
  const CalibrationReport report = solveCalibration(selector, kCamera.imageSize());
  EXPECT_THAT(reasonsOf(report), testing::ElementsAre(RefusalReason::kNoBoard));
}

TEST(Verdict, SaysThatItIsBlurred) {
  const CalibrationReport report =
      judged(support::calibrationPoses(kBoard, kCamera), {.edgeWidthPx = 8.0});
  EXPECT_THAT(reasonsOf(report), testing::ElementsAre(RefusalReason::kBlurred));
  EXPECT_THAT(report.refusals.front().text, HasSubstr("8.0 px"));
}

TEST(Verdict, RefusesALargeError) {
  EXPECT_THAT(reasonsOf(judged(support::calibrationPoses(kBoard, kCamera), {.noisePx = 0.7})),
              Contains(RefusalReason::kLargeError));
}

TEST(Verdict, RefusesABoardWhoseSquaresAreNone) {
  const auto reasons =
      reasonsOf(judged(support::calibrationPoses(kBoard, kCamera), {.stretchX = 1.1}));
  EXPECT_FALSE(reasons.empty());
}

TEST(Verdict, RefusesViewsThatWereSkewedWhileRowsWereRead) {
  EXPECT_FALSE(judged(support::calibrationPoses(kBoard, kCamera), {.skew = 0.01}).isGood());
}

}  // namespace
}  // namespace pleinair::calibration
