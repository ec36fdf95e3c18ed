#include "pipeline/tracking/pose/tag_pose.h"

#include <array>
#include <limits>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/random_vectors.h"
#include "tests/support/tag_scene.h"

namespace pleinair::tracking {
namespace {

using support::poseOf;
using support::trueCorners;

constexpr double kEdge = 0.1;

CameraModel webcam() {
  return {{.fx = 600.0, .fy = 605.0, .cx = 323.0, .cy = 238.0},
          {.k1 = -0.15, .k2 = 0.05, .p1 = 0.001, .p2 = -0.0005, .k3 = -0.01},
          {640, 480}};
}

TagCornersPx withNoise(TagCornersPx corners, double sigmaPx, std::mt19937& random) {
  std::normal_distribution<double> noise(0.0, sigmaPx);
  for (glm::dvec2& corner : corners) corner += support::randomVec2(noise, random);
  return corners;
}

double positionError(const PoseEstimate& pose, const glm::dmat4& truth) {
  return glm::distance(glm::dvec3(pose.cameraFromTarget[3]), glm::dvec3(truth[3]));
}

/// Tags in all orientations, up to 60° from the front.
std::vector<glm::dmat4> manyPoses() {
  std::vector<glm::dmat4> poses;
  for (int i = 0; i < 40; ++i) {
    const double turn = 0.9 * i;
    const double tilt = 0.1 + 0.024 * i;
    poses.push_back(poseOf({0.0, 0.0, turn}, {0.1 * std::cos(turn), 0.08 * std::sin(turn), 0.5}) *
                    poseOf(tilt * glm::dvec3(std::cos(2.0 * turn), std::sin(2.0 * turn), 0.0), {}));
  }
  return poses;
}

TEST(TagPose, OfExactCornersIsExact) {
  const CameraModel camera = webcam();
  for (const glm::dmat4& truth : manyPoses()) {
    const auto candidates = tagPoseCandidates(camera, trueCorners(camera, truth, kEdge), kEdge);
    ASSERT_FALSE(candidates.empty());
    const PoseEstimate& best = candidates[0];
    EXPECT_LT(best.rmsPx, 1e-6);
    EXPECT_LT(rotationBetweenRad(best.cameraFromTarget, truth), 1e-6);
    EXPECT_LT(positionError(best, truth), 1e-7);
    for (const PoseEstimate& each : candidates) EXPECT_GE(each.rmsPx, best.rmsPx);
  }
}

/// The tag's own frame: an upright tag in front of the camera has no rotation.
TEST(TagPose, OfAnUprightTagHasNoRotation) {
  const CameraModel camera = webcam();
  // Straight ahead, at the principal point, the two alternatives coincide.
  const glm::dmat4 truth = poseOf({}, {0.0, 0.0, 0.4});
  const auto candidates = tagPoseCandidates(camera, trueCorners(camera, truth, kEdge), kEdge);
  ASSERT_FALSE(candidates.empty());
  EXPECT_LT(rotationBetweenRad(candidates[0].cameraFromTarget, glm::dmat4(1.0)), 1e-3);
}

/// Noise of known size: errors stay within what the covariance predicts.
TEST(TagPose, PredictsItsOwnError) {
  const CameraModel camera = webcam();
  std::mt19937 random(7);
  constexpr double kNoisePx = 0.3;
  double rotationRatio = 0.0;
  double positionRatio = 0.0;
  int count = 0;
  for (const glm::dmat4& truth : manyPoses()) {
    const auto corners = withNoise(trueCorners(camera, truth, kEdge), kNoisePx, random);
    const auto pose = chooseTagPose(tagPoseCandidates(camera, corners, kEdge),
                                    PosePrior{.cameraFromTarget = truth});
    ASSERT_TRUE(pose);
    const double rotation = rotationBetweenRad(pose->estimate.cameraFromTarget, truth);
    EXPECT_LT(glm::degrees(rotation), 6.0);
    EXPECT_LT(positionError(pose->estimate, truth), 0.01);
    rotationRatio += rotation / pose->estimate.rotationSigmaRad();
    positionRatio += positionError(pose->estimate, truth) / pose->estimate.translationSigmaMetres();
    ++count;
  }
  EXPECT_GT(rotationRatio / count, 0.3);
  EXPECT_LT(rotationRatio / count, 3.0);
  EXPECT_GT(positionRatio / count, 0.3);
  EXPECT_LT(positionRatio / count, 3.0);
}

/// Seen from near the front or from afar, noise sometimes makes the wrong alternative fit better; a
/// pose from another source resolves the ambiguity.
TEST(TagPose, PriorRejectsTheWrongTwinNearTheFront) {
  const CameraModel camera = webcam();
  std::mt19937 random(3);
  constexpr double kMuchRad = 0.1;  // the prior is off by some, and so are both alternatives
  int wrongWithout = 0;
  int wrongWith = 0;
  for (int i = 0; i < 100; ++i) {
    const glm::dmat4 truth = poseOf({0.0, 0.0, 0.3 * i}, {0.1, -0.05, 1.5}) *
                             poseOf({0.15 * std::cos(i), 0.15 * std::sin(i), 0.0}, {});
    const auto candidates =
        tagPoseCandidates(camera, withNoise(trueCorners(camera, truth, kEdge), 0.2, random), kEdge);
    const auto without = chooseTagPose(candidates, std::nullopt);
    const PosePrior prior{.cameraFromTarget =
                              truth * poseOf({0.03, 0.02, 0.01}, {0.01, 0.0, 0.02})};
    const auto with = chooseTagPose(candidates, prior);
    ASSERT_TRUE(without && with);
    const auto isWrong = [&](const TagPose& pose) {
      return pose.alternative &&
             rotationBetweenRad(pose.estimate.cameraFromTarget, truth) >
                 rotationBetweenRad(pose.alternative->cameraFromTarget, truth) + kMuchRad;
    };
    if (isWrong(*without)) {
      ++wrongWithout;
      EXPECT_EQ(without->choice, AmbiguityResolution::kAmbiguous);
    }
    if (isWrong(*with)) {
      ++wrongWith;
    }
  }
  EXPECT_GT(wrongWithout, 5);
  EXPECT_EQ(wrongWith, 0);
}

TEST(TagPose, ErrorDecidesWhereItIsClear) {
  const CameraModel camera = webcam();
  const glm::dmat4 truth = poseOf({0.7, 0.0, 0.0}, {0.0, 0.0, 0.3});
  const auto candidates = tagPoseCandidates(camera, trueCorners(camera, truth, kEdge), kEdge);
  ASSERT_EQ(candidates.size(), 2U);
  // Even a contradicting prior does not help the wrong alternative.
  const auto pose =
      chooseTagPose(candidates, PosePrior{.cameraFromTarget = candidates[1].cameraFromTarget});
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->choice, AmbiguityResolution::kByError);
  EXPECT_LT(rotationBetweenRad(pose->estimate.cameraFromTarget, truth), 1e-6);
}

TEST(TagPose, OfDegenerateCornersIsNone) {
  const CameraModel camera = webcam();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const glm::dvec2 p(300.0, 200.0);
  const std::array<TagCornersPx, 5> degenerate{
      {{p, p, p, p},
       {p, p + glm::dvec2(10, 10), p + glm::dvec2(20, 20), p + glm::dvec2(30, 30)},
       {p, p + glm::dvec2(50, 0), p + glm::dvec2(50, 50), p + glm::dvec2(0, 50)},  // mirrored
       {p, p + glm::dvec2(50, 0), p + glm::dvec2(50, 0), p},
       {glm::dvec2(nan, 0.0), p, p + glm::dvec2(10, 0), p + glm::dvec2(0, 10)}}};
  for (std::size_t i = 0; i < degenerate.size(); ++i) {
    EXPECT_TRUE(tagPoseCandidates(camera, degenerate[i], kEdge).empty()) << i;
  }
  EXPECT_FALSE(chooseTagPose({}, std::nullopt));
}

}  // namespace
}  // namespace pleinair::tracking
