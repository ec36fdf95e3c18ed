#include "pipeline/tracking/pose/world_pose.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "pipeline/tracking/pose/tag_pose.h"
#include "tests/support/random_vectors.h"
#include "tests/support/tag_scene.h"

namespace pleinair::tracking {
namespace {

using support::poseOf;

CameraModel webcam() {
  return {{.fx = 600.0, .fy = 605.0, .cx = 323.0, .cy = 238.0},
          {.k1 = -0.15, .k2 = 0.05, .p1 = 0.001, .p2 = -0.0005, .k3 = -0.01},
          {640, 480}};
}

/// The assumed and the true pose of a tag.
struct PlacedTag {
  glm::dmat4 worldFromTag{1.0};
  glm::dmat4 movedBy{1.0};
  double edgeMetres = 0.05;
};

std::vector<WorldTag> seen(const CameraModel& camera, const std::vector<PlacedTag>& placed,
                           const glm::dmat4& cameraFromWorld, double noisePx,
                           std::mt19937& random) {
  std::normal_distribution<double> noise(0.0, 1.0);
  std::vector<WorldTag> tags;
  for (const PlacedTag& each : placed) {
    WorldTag tag{.worldFromTag = each.worldFromTag, .edgeMetres = each.edgeMetres};
    tag.corners = support::trueCorners(camera, cameraFromWorld * each.worldFromTag * each.movedBy,
                                       each.edgeMetres);
    for (glm::dvec2& px : tag.corners) px += noisePx * support::randomVec2(noise, random);
    tag.candidates = tagPoseCandidates(camera, tag.corners, tag.edgeMetres);
    tags.push_back(std::move(tag));
  }
  return tags;
}

/// Five tags on a table, each with its own rotation.
std::vector<PlacedTag> table(double edgeMetres) {
  std::vector<PlacedTag> placed;
  for (const glm::dvec2& at : {glm::dvec2(0.0, 0.0), glm::dvec2(0.18, 0.1), glm::dvec2(-0.2, 0.12),
                               glm::dvec2(0.16, -0.12), glm::dvec2(-0.15, -0.1)}) {
    placed.push_back(
        {.worldFromTag = poseOf({0.0, 0.0, 10.0 * at.x}, {at, 0.0}), .edgeMetres = edgeMetres});
  }
  return placed;
}

glm::dmat4 viewOf(int i, double distance) {
  return poseOf({0.05 * (i % 9) - 0.2, 0.06 * (i % 7) - 0.18, 0.3 * i}, {0.01, -0.02, distance});
}

double positionError(const WorldPose& pose, const glm::dmat4& truth) {
  return glm::distance(glm::dvec3(pose.estimate.cameraFromTarget[3]), glm::dvec3(truth[3]));
}

TEST(WorldPose, OfNoTagIsNone) {
  EXPECT_FALSE(WorldPoseSolver().solve(webcam(), {}, std::nullopt));
  const WorldTag withoutPose{.edgeMetres = 0.1};
  EXPECT_FALSE(WorldPoseSolver().solve(webcam(), {&withoutPose, 1}, std::nullopt));
}

TEST(WorldPose, OfExactCornersIsExact) {
  WorldPoseSolver solver;
  const CameraModel camera = webcam();
  std::mt19937 random(1);
  for (int i = 0; i < 20; ++i) {
    const glm::dmat4 truth = viewOf(i, 0.7);
    const auto pose =
        solver.solve(camera, seen(camera, table(0.05), truth, 0.0, random), std::nullopt);
    ASSERT_TRUE(pose);
    EXPECT_LT(rotationBetweenRad(pose->estimate.cameraFromTarget, truth), 1e-6);
    EXPECT_LT(positionError(*pose, truth), 1e-6);
    EXPECT_EQ(std::ranges::count(pose->agrees, 1), 5);
  }
}

/// Small noisy tags near the front, whose own poses are many degrees off and ambiguous: together
/// they determine the pose clearly.
TEST(WorldPose, OfSmallNoisyTagsIsRight) {
  WorldPoseSolver solver;
  const CameraModel camera = webcam();
  std::mt19937 random(2);
  double worst = 0.0;
  int left = 0;
  for (int i = 0; i < 60; ++i) {
    const glm::dmat4 truth = viewOf(i, 0.9);
    const auto pose =
        solver.solve(camera, seen(camera, table(0.03), truth, 0.3, random), std::nullopt);
    ASSERT_TRUE(pose);
    worst =
        std::max(worst, glm::degrees(rotationBetweenRad(pose->estimate.cameraFromTarget, truth)));
    left += static_cast<int>(std::ranges::count(pose->agrees, 0));
    EXPECT_NE(pose->choice, AmbiguityResolution::kAmbiguous);
  }
  RecordProperty("worst_rotation_deg", std::to_string(worst));
  EXPECT_LT(worst, 1.0);
  EXPECT_EQ(left, 0);
}

TEST(WorldPose, LeavesOutATagThatWasMoved) {
  WorldPoseSolver solver;
  const CameraModel camera = webcam();
  std::mt19937 random(3);
  for (int i = 0; i < 30; ++i) {
    std::vector<PlacedTag> placed = table(0.05);
    const auto moved = static_cast<std::size_t>(i) % placed.size();
    placed[moved].movedBy = poseOf({0.0, 0.0, 0.3}, {0.03, 0.02, 0.0});
    const glm::dmat4 truth = viewOf(i, 0.7);
    const auto pose = solver.solve(camera, seen(camera, placed, truth, 0.15, random), std::nullopt);
    ASSERT_TRUE(pose);
    for (std::size_t k = 0; k < placed.size(); ++k)
      EXPECT_EQ(pose->agrees[k] != 0, k != moved) << i;
    EXPECT_LT(glm::degrees(rotationBetweenRad(pose->estimate.cameraFromTarget, truth)), 0.5) << i;
    EXPECT_LT(positionError(*pose, truth), 0.004) << i;
  }
}

/// Two tags that contradict each other: one of them is used, and there is a pose.
TEST(WorldPose, OfTwoTagsThatDisagreeBelievesOne) {
  WorldPoseSolver solver;
  const CameraModel camera = webcam();
  std::mt19937 random(4);
  for (const double shift : {0.004, 0.006, 0.01, 0.05}) {
    std::vector<PlacedTag> placed = table(0.05);
    placed.resize(2);
    placed[1].movedBy = poseOf({}, {shift, 0.0, 0.0});
    const auto pose =
        solver.solve(camera, seen(camera, placed, viewOf(3, 0.6), 0.1, random), std::nullopt);
    ASSERT_TRUE(pose) << shift;
    EXPECT_GE(std::ranges::count(pose->agrees, 1), 1) << shift;
  }
}

/// Errors cannot tell which of the two was moved; the previous pose can.
TEST(WorldPose, OfTwoTagsThatDisagreeThePriorsIsBelieved) {
  WorldPoseSolver solver;
  const CameraModel camera = webcam();
  std::mt19937 random(6);
  const glm::dmat4 truth = viewOf(3, 0.6);
  const PosePrior prior{.cameraFromTarget = truth};
  for (const std::size_t moved : {std::size_t{0}, std::size_t{1}}) {
    std::vector<PlacedTag> placed = table(0.05);
    placed.resize(2);
    placed[moved].movedBy = poseOf({0.0, 0.0, 0.8}, {});
    for (int i = 0; i < 10; ++i) {
      const auto tags = seen(camera, placed, truth, 0.05, random);
      const auto unknown = solver.solve(camera, tags, std::nullopt);
      ASSERT_TRUE(unknown);
      EXPECT_EQ(unknown->choice, AmbiguityResolution::kAmbiguous);
      const auto known = solver.solve(camera, tags, prior);
      ASSERT_TRUE(known);
      EXPECT_EQ(known->choice, AmbiguityResolution::kByPrior);
      EXPECT_EQ(known->agrees[moved], 0);
      EXPECT_EQ(known->agrees[1 - moved], 1);
    }
  }
}

/// A single tag near the front: only the previous pose resolves the ambiguity.
TEST(WorldPose, OfOneTagKeepsToThePrior) {
  WorldPoseSolver solver;
  const CameraModel camera = webcam();
  std::mt19937 random(5);
  std::vector<PlacedTag> placed = table(0.05);
  placed.resize(1);
  int byPrior = 0;
  for (int i = 0; i < 50; ++i) {
    const glm::dmat4 truth = poseOf({0.1, 0.08, 0.2 * i}, {0.05, 0.02, 1.2});
    const PosePrior prior{.cameraFromTarget = truth * poseOf({0.02, 0.0, 0.01}, {0.005, 0.0, 0.0})};
    const auto tags = seen(camera, placed, truth, 0.2, random);
    const auto pose = solver.solve(camera, tags, prior);
    ASSERT_TRUE(pose);
    if (tags[0].candidates.size() < 2) continue;
    const double chosen = rotationBetweenRad(pose->estimate.cameraFromTarget, truth);
    for (const PoseEstimate& other : tags[0].candidates) {
      EXPECT_LE(chosen, rotationBetweenRad(
                            other.cameraFromTarget * glm::inverse(tags[0].worldFromTag), truth) +
                            0.05);
    }
    if (pose->choice == AmbiguityResolution::kByPrior) ++byPrior;
  }
  EXPECT_GT(byPrior, 25);
}

}  // namespace
}  // namespace pleinair::tracking
