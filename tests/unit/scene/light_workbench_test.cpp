#include <chrono>
#include <string>
#include <variant>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "hal/cameras/synthetic/synthetic_camera.h"
#include "pipeline/scene/attach_frame.h"
#include "pipeline/scene/light_estimator.h"
#include "tests/unit/scene/bench_light.h"

namespace pleinair::scene {
namespace {

constexpr int kTag = 0;  // on the bench's top
constexpr std::array<std::optional<int>, 1> kPlaces{kTag};
constexpr glm::dvec3 kPaper{0.78, 0.77, 0.74};  // papers.cpp's white

/// The tracker and the estimator on what the synthetic camera sees.
class Watching {
 public:
  explicit Watching(const hal::SyntheticOptions& options)
      : options_(options), camera_(options, clock_) {
    const hal::GroundTruth truth = camera_.truth(0);
    for (const hal::TagTruth& each : truth.tags) {
      markers_.push_back({.id = each.tag.id,
                          .edgeMetres = each.tag.edgeMetres,
                          .worldFromTag = each.tag.worldFromTag});
    }
    const auto& pinhole = truth.intrinsics;
    tracker_.emplace(
        tracking::CameraModel({pinhole.fx, pinhole.fy, pinhole.cx, pinhole.cy}, {}, options.size),
        markers_);
    estimator_.emplace(markers_, "tag36h11", kPlaces);
    EXPECT_TRUE(camera_.start({}));
  }

  const Lighting& next() {
    clock_.advance(options_.framePeriod);
    const hal::NextFrame next = camera_.next(clock_.now() + std::chrono::seconds(1));
    const auto& frame = std::get<hal::CapturedFrame>(next);
    const auto tracked = tracker_->track(frame.image, frame.captureTime);
    estimator_->follow(frame.image, tracked, frame.captureTime);
    return estimator_->lights()[0].light;
  }

 private:
  hal::SyntheticOptions options_;
  hal::SteppedClock clock_;
  hal::SyntheticCamera camera_;
  std::vector<tracking::TagMarker> markers_;
  std::optional<tracking::Tracker> tracker_;
  std::optional<LightEstimator> estimator_;
};

double degreesApart(const glm::vec3& a, const glm::dvec3& b) {
  return glm::degrees(std::acos(glm::dot(glm::normalize(glm::dvec3(a)), glm::normalize(b))));
}

const BenchLight& truth() {
  static const BenchLight kLight = benchLightAt({0.0, 0.0, 0.01}, {0.0, 0.0, 1.0});
  return kLight;
}

/// The largest difference of two colours' shares, however bright they are.
double castError(const glm::vec3& is, const glm::dvec3& should) {
  const glm::dvec3 a = glm::dvec3(is) / double{is.r + is.g + is.b};
  const glm::dvec3 b = should / (should.r + should.g + should.b);
  return glm::length(a - b);
}

class LightOnTheWorkbench : public testing::TestWithParam<hal::SyntheticShot> {};

TEST_P(LightOnTheWorkbench, IsWhereTheSunIs) {
  Watching watching({.shot = GetParam()});
  double largest = 0.0;
  for (int i = 0; i < 45; ++i) {
    const Lighting& light = watching.next();
    largest = std::max(largest, degreesApart(light.towardKey, truth().towardKey));
    EXPECT_LT(castError(light.white, kPaper * truth().onPlane), 0.05);
  }
  RecordProperty("key_error_degrees", std::to_string(largest));
  EXPECT_LT(largest, 30.0);
  // Where the scene's default light is; that one would be far off.
  EXPECT_GT(degreesApart({-0.37F, 0.56F, 0.74F}, truth().towardKey), 55.0);
}

INSTANTIATE_TEST_SUITE_P(Shots, LightOnTheWorkbench,
                         testing::Values(hal::SyntheticShot::kStill,
                                         hal::SyntheticShot::kWalkaround, hal::SyntheticShot::kPan,
                                         hal::SyntheticShot::kOccluder),
                         [](const auto& shot) { return std::string(hal::toString(shot.param)); });

TEST(LightOnTheWorkbenchTest, DriftMovesTheLevelAndNotTheKey) {
  Watching steady({.shot = hal::SyntheticShot::kStill});
  Watching drifting(
      {.shot = hal::SyntheticShot::kStill, .exposureDriftStops = 0.5, .whiteBalanceDrift = 0.2});
  double levels = 0.0;
  for (int i = 0; i < 90; ++i) {
    const Lighting& still = steady.next();
    const Lighting& now = drifting.next();
    EXPECT_LT(degreesApart(now.towardKey, still.towardKey), 6.0) << "frame " << i;
    levels = std::max(levels, std::abs(std::log2(double{now.white.g} / still.white.g)));
  }
  EXPECT_GT(levels, 0.1);
}

}  // namespace
}  // namespace pleinair::scene
