#include "pipeline/tracking/pose/twist.h"

#include <array>
#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/random_vectors.h"
#include "tests/support/tag_scene.h"

namespace pleinair::tracking {
namespace {

using support::poseOf;

const glm::dmat4 kPose = poseOf({0.3, -0.4, 1.2}, {0.1, -0.2, 0.8});

TEST(Twist, MovesThereAndSaysWhatMoved) {
  const Twist motion{.rotation = {0.02, -0.3, 0.1}, .shift = {0.01, 0.02, -0.03}};
  const glm::dmat4 there = movedBy(kPose, motion);
  const Twist found = motionBetween(kPose, there);
  EXPECT_LT(glm::distance(found.rotation, motion.rotation), 1e-12);
  EXPECT_LT(glm::distance(found.shift, motion.shift), 1e-12);
  // In camera axes, about the target's origin.
  EXPECT_LT(glm::distance(glm::dvec3(there[3]), glm::dvec3(kPose[3]) + motion.shift), 1e-12);
}

TEST(Twist, TheInverseTakesBack) {
  const glm::dmat4 product = rigidInverse(kPose) * kPose;
  for (int column = 0; column < 4; ++column) {
    EXPECT_LT(glm::distance(product[column], glm::dmat4(1.0)[column]), 1e-12);
  }
}

/// The spread of a tag's pose, drawn from the world's, agrees with atPoint().
TEST(Twist, ACovarianceIsSeenFromAnotherPoint) {
  const PoseCovariance ofWorld = isotropic(0.01, 0.002);
  const glm::dmat4 worldFromTag = poseOf({0.0, 0.5, 0.0}, {0.3, 0.1, -0.1});
  const glm::dvec3 arm = glm::dmat3(kPose) * glm::dvec3(worldFromTag[3]);
  const PoseCovariance predicted = atPoint(ofWorld, arm);
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const auto vector = [&](double sigma) { return sigma * support::randomVec3(normal, random); };
  std::array<double, 36> sums{};
  constexpr int kDraws = 20000;
  for (int i = 0; i < kDraws; ++i) {
    const glm::dmat4 moved = movedBy(kPose, {.rotation = vector(0.01), .shift = vector(0.002)});
    const Twist m = motionBetween(kPose * worldFromTag, moved * worldFromTag);
    const std::array<double, 6> v{m.rotation.x, m.rotation.y, m.rotation.z,
                                  m.shift.x,    m.shift.y,    m.shift.z};
    for (std::size_t k = 0; k < 36; ++k) sums[k] += v[k / 6] * v[k % 6] / kDraws;
  }
  for (std::size_t k = 0; k < 36; ++k) {
    const double scale = std::sqrt(predicted[7 * (k / 6)] * predicted[7 * (k % 6)]);
    EXPECT_NEAR(sums[k], predicted[k], 0.05 * scale) << k;
  }
  EXPECT_GT(predicted[21], 1.5 * ofWorld[21]) << "a turn shifts what is far";
}

}  // namespace
}  // namespace pleinair::tracking
