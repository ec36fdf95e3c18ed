#include "pipeline/calibration/view_selection.h"

#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/board_scene.h"

namespace pleinair::calibration {
namespace {

using support::BoardHold;

const Board kBoard(Checkerboard{9, 6, 0.025});
const tracking::CameraModel kCamera({600, 600, 320, 240}, {}, {640, 480});
constexpr hal::Duration kPeriod = std::chrono::milliseconds(33);

/// Shows boards to a selector, one frame period apart.
class ViewSelection : public testing::Test {
 protected:
  ViewOutcome show(const BoardHold& hold, double edgeWidthPx = 1.5) {
    BoardSighting sighting = support::idealSighting(
        kBoard, kCamera, support::cameraFromBoard(kBoard, kCamera, hold), 0.05, frame_ + 1);
    sighting.edgeWidthPx = edgeWidthPx;
    return offer(std::move(sighting));
  }
  /// Twice, so that the board is known to be at rest.
  ViewOutcome hold(const BoardHold& held, double edgeWidthPx = 1.5) {
    show(held, edgeWidthPx);
    return show(held, edgeWidthPx);
  }
  ViewOutcome offer(std::optional<BoardSighting> sighting) {
    const auto frame = frame_++;
    return selector_.offer(frame, hal::TimePoint(frame * kPeriod), std::move(sighting));
  }

  ViewSelector selector_{kBoard, kCamera.imageSize()};
  std::uint32_t frame_ = 0;
};

TEST_F(ViewSelection, TakesAStillViewOnce) {
  EXPECT_EQ(show({}), ViewOutcome::kMoving);  // nothing to compare with yet
  EXPECT_EQ(show({}), ViewOutcome::kTaken);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(show({}), ViewOutcome::kNothingNew);
  EXPECT_EQ(selector_.views().size(), 1u);
  EXPECT_EQ(offer(std::nullopt), ViewOutcome::kNoBoard);
  EXPECT_EQ(selector_.counts().pictures, 23u);
  EXPECT_EQ(selector_.counts().withBoard, 22u);
}

TEST_F(ViewSelection, LeavesOutMovingBoards) {
  // 3 px per image are 90 px per second: rows would shift by a pixel or two.
  for (int i = 0; i < 40; ++i) {
    EXPECT_EQ(show({.at = {0.3 + i * 3.0 / 640.0, 0.5}}), ViewOutcome::kMoving);
  }
  EXPECT_TRUE(selector_.views().empty());
}

TEST_F(ViewSelection, TakesASlowHand) {
  // 0.4 px per image: a hand that tries to hold still.
  show({});
  EXPECT_EQ(show({.at = {0.5 + 0.4 / 640.0, 0.5}}), ViewOutcome::kTaken);
}

TEST_F(ViewSelection, LeavesOutBlurredBoards) {
  hold({}, 1.5);
  EXPECT_EQ(hold({.at = {0.3, 0.5}, .yaw = 0.5}, 2.6), ViewOutcome::kBlurred);
  EXPECT_EQ(show({.at = {0.3, 0.5}, .yaw = 0.5}, 1.8), ViewOutcome::kTaken);
}

TEST_F(ViewSelection, ABlurredOneIsDroppedOnceSharperOnesCome) {
  hold({.at = {0.3, 0.5}, .yaw = 0.5}, 4.0);
  ASSERT_EQ(selector_.views().size(), 1u);
  for (int i = 0; i < 3; ++i) hold({.at = {0.6, 0.5}}, 1.5);
  ASSERT_EQ(selector_.views().size(), 1u);
  EXPECT_EQ(selector_.views()[0].sighting.edgeWidthPx, 1.5);
  // Its tilt is required again.
  EXPECT_EQ(selector_.coverage().viewsWith(Tilt::kLeftNearer), 0);
}

TEST_F(ViewSelection, ASharperOneTakesThePlaceOfTheSameView) {
  hold({}, 2.0);
  EXPECT_EQ(show({}, 1.9), ViewOutcome::kNothingNew);
  EXPECT_EQ(show({}, 1.5), ViewOutcome::kTaken);
  ASSERT_EQ(selector_.views().size(), 1u);
  EXPECT_EQ(selector_.views()[0].sighting.edgeWidthPx, 1.5);
}

TEST_F(ViewSelection, OnePictureMistakenForSharpDoesNotSpoilTheRest) {
  for (int i = 0; i < 6; ++i) show({.at = {0.3 + 0.08 * i, 0.5}}, 2.0);
  show({}, 0.9);
  EXPECT_EQ(hold({.at = {0.3, 0.6}, .yaw = 0.5}, 2.0), ViewOutcome::kTaken);
}

TEST_F(ViewSelection, IsCompleteAfterAGoodTourWithFewViews) {
  for (const BoardHold& held : support::calibrationPoses(kBoard, kCamera)) hold(held);
  EXPECT_TRUE(selector_.isComplete()) << *selector_.coverage().missingViews();
  EXPECT_LE(selector_.views().size(), 26u);
  EXPECT_EQ(selector_.fitViews().size(), selector_.views().size());
}

TEST_F(ViewSelection, NeverTakesMoreThanItMay) {
  const auto tour = support::calibrationPoses(kBoard, kCamera);
  for (int round = 0; round < 6; ++round) {
    for (BoardHold held : tour) {
      held.roll += 0.25 * round;
      held.span *= 1.0 - 0.05 * round;
      hold(held);
    }
  }
  EXPECT_EQ(selector_.views().size(), 40u);
  EXPECT_TRUE(selector_.isComplete());
}

TEST_F(ViewSelection, PhotographsNeedNotFollowEachOther) {
  ViewSelector photographs(kBoard, kCamera.imageSize(), {.isSequence = false});
  std::uint32_t frame = 0;
  for (const BoardHold& held : support::calibrationPoses(kBoard, kCamera)) {
    photographs.offer(
        frame, hal::TimePoint(frame * kPeriod),
        support::idealSighting(kBoard, kCamera, support::cameraFromBoard(kBoard, kCamera, held)));
    ++frame;
  }
  EXPECT_TRUE(photographs.isComplete());
  EXPECT_EQ(photographs.counts().moving, 0u);
}

}  // namespace
}  // namespace pleinair::calibration
