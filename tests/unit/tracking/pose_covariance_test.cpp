#include <chrono>
#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "pipeline/tracking/pose/tracker.h"
#include "pipeline/tracking/pose/twist.h"
#include "tests/support/tag_scene.h"

namespace pleinair::tracking {
namespace {

using namespace std::chrono_literals;
using support::poseOf;

constexpr double kEdge = 0.06;

CameraModel webcam() {
  return {{.fx = 600.0, .fy = 605.0, .cx = 323.0, .cy = 238.0}, {}, {640, 480}};
}

std::vector<glm::dvec3> cube() {
  std::vector<glm::dvec3> points;
  for (const double height : {0.0, kEdge}) {
    for (const glm::dvec3& foot : tagCorners(kEdge)) {
      points.push_back(foot - glm::dvec3(0.0, 0.0, height));
    }
  }
  return points;
}

double squaredErrorOfCubePx(const glm::dmat4& pose, const glm::dmat4& truth) {
  double sum = 0.0;
  for (const glm::dvec3& point : cube()) {
    const glm::dvec2 apart = webcam().project(glm::dvec3(pose * glm::dvec4(point, 1.0))) -
                             webcam().project(glm::dvec3(truth * glm::dvec4(point, 1.0)));
    sum += glm::dot(apart, apart) / 8.0;
  }
  return sum;
}

struct Ratio {
  double actual = 0.0;
  double predicted = 0.0;
  void add(const glm::dmat4& pose, const PoseCovariance& covariance, const glm::dmat4& truth) {
    actual += squaredErrorOfCubePx(pose, truth);
    predicted += projectedVariancePx(webcam(), pose, covariance, cube());
  }
  double value() const { return std::sqrt(actual / predicted); }
};

/// Tags in random poses under noise: errors of a model on them agree with the covariances within a
/// factor of two, at first sight and filtered; for a tag in the world too.
TEST(PoseCovariance, SaysHowLargeErrorsAre) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const glm::dmat4 worldFromTag = poseOf({0.0, 0.0, 0.7}, {0.2, -0.1, 0.0});
  Ratio first;
  Ratio filtered;
  Ratio world;
  for (int i = 0; i < 16; ++i) {
    const glm::dvec3 place{0.1 * uniform(random), 0.08 * uniform(random),
                           0.55 + 0.1 * uniform(random)};
    const glm::dmat4 truth =
        poseOf({0.6 + 0.2 * uniform(random), 0.3 * uniform(random), uniform(random)}, place);
    const support::SceneTag tag{.id = 4, .edgeMetres = kEdge, .worldFromTag = truth};
    Tracker loose(webcam(), {{.id = 4, .edgeMetres = kEdge}});
    Tracker placed(webcam(), {{.id = 4, .edgeMetres = kEdge, .worldFromTag = worldFromTag}});
    for (int frame = 0; frame < 4; ++frame) {
      const hal::Image image =
          support::renderTags(webcam(), glm::dmat4(1.0), {&tag, 1},
                              {.samplesPerSide = 4,
                               .noiseSigma = 3.0,
                               .noiseSeed = static_cast<std::uint32_t>(random())});
      const TrackingResult result = loose.track(image.view(), hal::TimePoint(33ms * frame));
      ASSERT_EQ(result.tags.size(), 1U);
      Ratio& ratio = frame == 0 ? first : filtered;
      ratio.add(*result.tags[0].cameraFromTag, result.tags[0].covariance, truth);
      const TrackingResult inWorld = placed.track(image.view(), hal::TimePoint(33ms * frame));
      world.add(*inWorld.tags[0].cameraFromTag, inWorld.tags[0].covariance, truth);
    }
  }
  for (const auto& [name, ratio] :
       {std::pair("first", first), {"filtered", filtered}, {"world", world}}) {
    RecordProperty(name, std::to_string(ratio.value()));
    EXPECT_GT(ratio.value(), 0.5) << name;
    EXPECT_LT(ratio.value(), 2.0) << name;
  }
}

}  // namespace
}  // namespace pleinair::tracking
