#include "pipeline/calibration/board_detector.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/board_scene.h"

namespace pleinair::calibration {
namespace {

using support::BoardHold;

const Board kCheckerboard(Checkerboard{9, 6, 0.025});
const Board kGrid(AprilGrid{6, 6, 0.03, 0.3, 0});
const tracking::CameraModel kBarrel({420, 422, 325.3, 236.2}, {.k1 = -0.3, .k2 = 0.09}, {640, 480});

struct Accuracy {
  double rmsPx = 0.0;
  glm::dvec2 bias{0.0};
};

/// A checkerboard upside down looks the same.
Accuracy accuracyOf(const Board& board, const BoardSighting& sighting, const glm::dmat4& pose) {
  Accuracy best{.rmsPx = 1e9};
  for (const double sign : {1.0, -1.0}) {
    Accuracy now;
    for (const SightedCorner& corner : sighting.corners) {
      glm::dvec3 at = board.corners()[static_cast<std::size_t>(corner.id)];
      at *= sign;
      const glm::dvec2 error = corner.px - kBarrel.project(glm::dvec3(pose * glm::dvec4(at, 1.0)));
      now.rmsPx += glm::dot(error, error);
      now.bias += error;
    }
    const auto count = static_cast<double>(sighting.corners.size());
    now.rmsPx = std::sqrt(now.rmsPx / count);
    now.bias /= count;
    if (now.rmsPx < best.rmsPx) best = now;
  }
  return best;
}

std::optional<BoardSighting> seen(const Board& board, const hal::Image& picture) {
  return makeBoardDetector(board)->detect(picture.view().planes[0], picture.size());
}

class EveryBoard : public testing::TestWithParam<const Board*> {};

TEST_P(EveryBoard, CornersAreWhereTheyAreToATenthOfAPixel) {
  const Board& board = *GetParam();
  const support::BoardRenderer renderer(board, kBarrel);
  glm::dvec2 bias(0.0);
  const std::vector<BoardHold> holds{{.span = 0.6, .yaw = 0.4},
                                     {.at = {0.42, 0.55}, .span = 0.55, .pitch = 0.4, .roll = 0.5},
                                     {.at = {0.6, 0.45}, .span = 0.5, .yaw = -0.3, .roll = -0.2}};
  for (const BoardHold& hold : holds) {
    const glm::dmat4 pose = support::cameraFromBoard(board, kBarrel, hold);
    const auto sighting =
        seen(board, renderer.render(pose, {.blurSigmaPx = 0.6, .noiseSigma = 2.0}));
    ASSERT_TRUE(sighting);
    EXPECT_GT(sighting->corners.size(), board.corners().size() * 3 / 4);
    const Accuracy accuracy = accuracyOf(board, *sighting, pose);
    EXPECT_LT(accuracy.rmsPx, 0.2);
    bias += accuracy.bias / static_cast<double>(holds.size());
    EXPECT_GT(sighting->edgeWidthPx, 1.5);
    EXPECT_LT(sighting->edgeWidthPx, 2.6);
  }
  // Pixel centres taken as integers would bias corners by half a pixel.
  EXPECT_LT(glm::length(bias), 0.03);
}

TEST_P(EveryBoard, EdgesWidenWithBlur) {
  const Board& board = *GetParam();
  const support::BoardRenderer renderer(board, kBarrel);
  const glm::dmat4 pose = support::cameraFromBoard(board, kBarrel, {.span = 0.8});
  double before = 0.0;
  for (const double sigma : {0.5, 1.0, 1.6}) {
    const auto sighting = seen(board, renderer.render(pose, {.blurSigmaPx = sigma}));
    ASSERT_TRUE(sighting) << sigma;
    EXPECT_GT(sighting->edgeWidthPx, before + 0.5) << sigma;
    EXPECT_NEAR(sighting->edgeWidthPx, std::sqrt(6.28 * sigma * sigma + 1.0), 0.6) << sigma;
    before = sighting->edgeWidthPx;
  }
}

TEST_P(EveryBoard, AnEmptyPictureHasNone) {
  hal::Image picture({.pixelFormat = hal::PixelFormat::kGrey8, .size = {640, 480}});
  EXPECT_FALSE(seen(*GetParam(), picture));
}

INSTANTIATE_TEST_SUITE_P(Boards, EveryBoard, testing::Values(&kCheckerboard, &kGrid),
                         [](const auto& board) {
                           return board.param == &kCheckerboard ? "Checkerboard" : "AprilGrid";
                         });

TEST(AprilGridDetector, SeesAGridThatIsPartlyOutOfThePicture) {
  const support::BoardRenderer renderer(kGrid, kBarrel);
  const glm::dmat4 pose =
      support::cameraFromBoard(kGrid, kBarrel, {.at = {0.15, 0.2}, .span = 0.8});
  const auto sighting = seen(kGrid, renderer.render(pose, {.blurSigmaPx = 0.6, .noiseSigma = 2.0}));
  ASSERT_TRUE(sighting);
  EXPECT_LT(sighting->corners.size(), 100u);
  EXPECT_LT(accuracyOf(kGrid, *sighting, pose).rmsPx, 0.3);
}

TEST(AprilGridDetector, TakesNoOtherGrid) {
  const support::BoardRenderer renderer(kGrid, kBarrel);
  const hal::Image picture =
      renderer.render(support::cameraFromBoard(kGrid, kBarrel, {.span = 0.7}));
  EXPECT_FALSE(seen(Board(AprilGrid{5, 6, 0.03, 0.3, 0}), picture));
  EXPECT_FALSE(seen(Board(AprilGrid{6, 6, 0.03, 0.3, 100}), picture));
}

TEST(OtherBoard, IsNamed) {
  const support::BoardRenderer renderer(kCheckerboard, kBarrel);
  const hal::Image picture =
      renderer.render(support::cameraFromBoard(kCheckerboard, kBarrel, {.span = 0.5}));
  const hal::PlaneView luma = picture.view().planes[0];
  // A user who counts squares enters 10x7.
  EXPECT_EQ(otherBoardIn(Board(Checkerboard{10, 7, 0.025}), luma, picture.size()),
            "a checkerboard of 9x6 inner corners");
  EXPECT_FALSE(otherBoardIn(kGrid, luma, picture.size()));
}

}  // namespace
}  // namespace pleinair::calibration
