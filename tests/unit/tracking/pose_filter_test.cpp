#include "pipeline/tracking/pose/pose_filter.h"

#include <cmath>
#include <deque>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/random_vectors.h"
#include "tests/support/tag_scene.h"

namespace pleinair::tracking {
namespace {

using support::poseOf;

constexpr double kTurnNoise = 0.004;
constexpr double kShiftNoise = 0.001;

/// A tag's pose with noise of known covariance.
class NoisyTag {
 public:
  PoseEstimate see(const glm::dmat4& truth) {
    return {.cameraFromTarget =
                movedBy(truth, {.rotation = vector(kTurnNoise), .shift = vector(kShiftNoise)}),
            .covariance = isotropic(kTurnNoise, kShiftNoise)};
  }

 private:
  glm::dvec3 vector(double sigma) { return sigma * support::randomVec3(normal_, random_); }
  std::mt19937 random_{11};
  std::normal_distribution<double> normal_;
};

const PoseCovariance kSureMotion = isotropic(0.0001, 0.00003);

double shiftError(const glm::dmat4& a, const glm::dmat4& b) {
  return glm::length(motionBetween(a, b).shift);
}

TEST(PoseFilter, TremblesFarLessThanWhatItIsTold) {
  const glm::dmat4 truth = poseOf({0.4, 0.1, 0.0}, {0.0, 0.0, 0.7});
  NoisyTag tag;
  PoseFilter filter;
  filter.start(tag.see(truth));
  double told = 0.0;
  double filtered = 0.0;
  glm::dmat4 lastSeen = truth;
  for (int i = 0; i < 200; ++i) {
    const PoseEstimate seen = tag.see(truth);
    const glm::dmat4 before = filter.cameraFromTarget();
    filter.predict(before, kSureMotion);
    filter.correct(seen, 1.0);
    if (i < 50) continue;
    told += std::pow(shiftError(lastSeen, seen.cameraFromTarget), 2);
    filtered += std::pow(shiftError(before, filter.cameraFromTarget()), 2);
    lastSeen = seen.cameraFromTarget;
  }
  EXPECT_LT(std::sqrt(filtered), 0.1 * std::sqrt(told));
}

/// The filter follows a moving target without lag; the mean of the last eight sightings has no less
/// noise, and lags.
TEST(PoseFilter, DoesNotLagAsAMovingAverageDoes) {
  NoisyTag tag;
  PoseFilter filter;
  std::deque<glm::dvec3> window;
  double ours = 0.0;
  double average = 0.0;
  glm::dmat4 before(1.0);
  for (int i = 0; i < 90; ++i) {
    const glm::dmat4 truth = poseOf({0.4, 0.1, 0.0}, {0.01 * i, 0.0, 0.7});
    const PoseEstimate seen = tag.see(truth);
    if (i == 0) {
      filter.start(seen);
    } else {
      filter.predict(movedBy(filter.cameraFromTarget(), motionBetween(before, truth)), kSureMotion);
      filter.correct(seen, 1.0);
    }
    before = truth;
    window.emplace_back(seen.cameraFromTarget[3]);
    if (window.size() > 8) window.pop_front();
    glm::dvec3 mean(0.0);
    for (const glm::dvec3& each : window) mean += each / static_cast<double>(window.size());
    if (i < 30) continue;
    ours += truth[3].x - filter.cameraFromTarget()[3].x;
    average += truth[3].x - mean.x;
  }
  EXPECT_LT(std::abs(ours / 60.0), 0.0003);
  EXPECT_GT(average / 60.0, 0.03);
}

/// With the gain of its own covariance, errors are as large as predicted.
TEST(PoseFilter, KnowsHowGoodItIs) {
  const glm::dmat4 truth = poseOf({0.4, 0.1, 0.0}, {0.0, 0.0, 0.7});
  NoisyTag tag;
  double squared = 0.0;
  double predicted = 0.0;
  for (int run = 0; run < 200; ++run) {
    PoseFilter filter;
    filter.start(tag.see(truth));
    for (int i = 0; i < 10; ++i) {
      filter.predict(filter.cameraFromTarget(), isotropic(0.0, 0.0));
      filter.correct(tag.see(truth), 1.0);
    }
    squared += std::pow(shiftError(truth, filter.cameraFromTarget()), 2);
    const PoseCovariance covariance = filter.covariance();
    predicted += covariance[21] + covariance[28] + covariance[35];
  }
  EXPECT_NEAR(std::sqrt(squared / predicted), 1.0, 0.15);
}

TEST(PoseFilter, DoubtMakesASightingCountAtOnce) {
  const glm::dmat4 truth = poseOf({0.4, 0.1, 0.0}, {0.0, 0.0, 0.7});
  NoisyTag tag;
  PoseFilter filter;
  filter.start(tag.see(truth));
  for (int i = 0; i < 50; ++i) filter.correct(tag.see(truth), 1.0);
  const glm::dmat4 moved = movedBy(truth, {.rotation = {}, .shift = {0.02, 0.0, 0.0}});
  PoseFilter sure = filter;
  sure.correct(tag.see(moved), 1.0);
  filter.correct(tag.see(moved), 100.0);
  EXPECT_GT(shiftError(sure.cameraFromTarget(), moved), 0.015);
  EXPECT_LT(shiftError(filter.cameraFromTarget(), moved), 0.005);
}

}  // namespace
}  // namespace pleinair::tracking
