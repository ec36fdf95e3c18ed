#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "hal/cameras/synthetic/synthetic_camera.h"
#include "pipeline/scene/description/scene.h"
#include "pipeline/scene/light/light_estimator.h"
#include "tests/unit/scene/bench_light.h"

namespace pleinair::scene {
namespace {

constexpr int kTag = 0;  // on the bench's top
constexpr std::array<std::optional<int>, 1> kPlaces{kTag};
constexpr glm::dvec3 kPaper{0.78, 0.77, 0.74};  // the white of papers.cpp

/// Runs the tracker and the estimator on images of the synthetic camera.
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
    atOnce_.emplace(markers_, "tag36h11", kPlaces);
    EXPECT_TRUE(camera_.start({}));
  }

  const Lighting& next() {
    clock_.advance(options_.framePeriod);
    const hal::NextFrame next = camera_.next(clock_.now() + std::chrono::seconds(1));
    const auto& frame = std::get<hal::CapturedFrame>(next);
    const auto tracked = tracker_->track(frame.image.map().view(), frame.captureTime);
    estimator_->follow(frame.image.map().view(), tracked, frame.captureTime);
    atOnce_->reset();
    atOnce_->follow(frame.image.map().view(), tracked, frame.captureTime);
    return estimator_->lights()[0].light;
  }
  /// Estimates from the same frame as if it were the first.
  const Lighting& atOnce() const { return atOnce_->lights()[0].light; }

 private:
  hal::SyntheticOptions options_;
  hal::SteppedClock clock_;
  hal::SyntheticCamera camera_;
  std::vector<tracking::TagMarker> markers_;
  std::optional<tracking::Tracker> tracker_;
  std::optional<LightEstimator> estimator_, atOnce_;
};

double degreesApart(const glm::vec3& a, const glm::dvec3& b) {
  const double cosine = glm::dot(glm::normalize(glm::dvec3(a)), glm::normalize(b));
  return glm::degrees(std::acos(std::min(cosine, 1.0)));
}

const BenchLight& truth() {
  static const BenchLight kLight = benchLightAt({0.0, 0.0, 0.01}, {0.0, 0.0, 1.0});
  return kLight;
}

/// Expected colour of the white border around the tag.
const glm::dvec3& trueWhite() {
  static const glm::dvec3 kWhite = [] {
    glm::dvec3 sum(0.0);
    constexpr int kPoints = 24;
    for (int i = 0; i < kPoints; ++i) {
      const double along = 0.1 * ((i % 6) / 5.0 - 0.5);
      const double across = (i / 6) % 2 == 0 ? 0.056 : -0.056;
      const glm::dvec3 at =
          i < 12 ? glm::dvec3(along, across, 0.001) : glm::dvec3(across, along, 0.001);
      sum += benchIrradiance(at, {0.0, 0.0, 1.0});
    }
    return kPaper * sum / double{kPoints};
  }();
  return kWhite;
}

/// The largest difference of two colours' chromaticities, whatever their brightness.
double castError(const glm::vec3& is, const glm::dvec3& should) {
  const glm::dvec3 a = glm::dvec3(is) / double{is.r + is.g + is.b};
  const glm::dvec3 b = should / (should.r + should.g + should.b);
  return glm::length(a - b);
}

double stopsApart(const glm::vec3& is, const glm::dvec3& should) {
  return std::abs(std::log2(double{is.g} / should.g));
}

/// Collects the largest of the added values, and records it by name in the test's report.
class Largest {
 public:
  explicit Largest(std::string name) : name_(std::move(name)) {}
  ~Largest() { testing::Test::RecordProperty(name_, std::to_string(value_)); }
  Largest(const Largest&) = delete;
  Largest& operator=(const Largest&) = delete;
  void add(double value) { value_ = std::max(value_, value); }
  double value() const { return value_; }

 private:
  std::string name_;
  double value_ = 0.0;
};

class LightOnTheWorkbench : public testing::TestWithParam<hal::SyntheticShot> {};

TEST_P(LightOnTheWorkbench, IsWhereTheSunIs) {
  Watching watching({.shot = GetParam()});
  Largest key("key_error_degrees"), stops("level_error_stops"), cast("cast_error");
  Largest turn("key_turn_degrees_a_frame");
  glm::vec3 before(0.0F);
  for (int i = 0; i < 60; ++i) {
    const Lighting& light = watching.next();
    key.add(degreesApart(light.towardKey, truth().towardKey));
    stops.add(stopsApart(light.white, trueWhite()));
    cast.add(castError(light.white, trueWhite()));
    if (i > 0) turn.add(degreesApart(light.towardKey, before));
    before = light.towardKey;
  }
  EXPECT_LT(key.value(), 30.0);
  EXPECT_LT(stops.value(), 0.35);
  EXPECT_LT(cast.value(), 0.05);
  EXPECT_LT(turn.value(), 2.0);
  // For a scene with the default light, which would be far off here.
  EXPECT_GT(degreesApart({-0.37F, 0.56F, 0.74F}, truth().towardKey), 55.0);
}

INSTANTIATE_TEST_SUITE_P(Shots, LightOnTheWorkbench,
                         testing::Values(hal::SyntheticShot::kStill,
                                         hal::SyntheticShot::kWalkaround, hal::SyntheticShot::kPan,
                                         hal::SyntheticShot::kOccluder),
                         [](const auto& shot) { return std::string(hal::toString(shot.param)); });

/// With sensor noise, and the noise in poses that follows from it.
TEST(LightOnTheWorkbenchTest, RestsOnAStillShot) {
  Watching watching({.shot = hal::SyntheticShot::kStill});
  for (int i = 0; i < 15; ++i) watching.next();
  Lighting last = watching.next();
  int changes = 0;
  for (int i = 0; i < 60; ++i) {
    const Lighting& now = watching.next();
    if (now.towardKey != last.towardKey || now.white != last.white || now.key != last.key) {
      ++changes;
    }
    last = now;
  }
  RecordProperty("frames_with_a_change_of_60", changes);
  EXPECT_EQ(changes, 0);
}

TEST(LightOnTheWorkbenchTest, DriftMovesTheLevelAndNotTheKey) {
  Watching steady({.shot = hal::SyntheticShot::kStill});
  Watching drifting(
      {.shot = hal::SyntheticShot::kStill, .exposureDriftStops = 0.5, .whiteBalanceDrift = 0.2});
  Largest turn("key_turn_by_drift_degrees"), moved("drift_stops");
  Largest lag("level_behind_stops"), cast("cast_behind");
  for (int i = 0; i < 90; ++i) {
    const Lighting still = steady.next();
    const Lighting now = drifting.next();
    turn.add(degreesApart(now.towardKey, still.towardKey));
    moved.add(stopsApart(now.white, glm::dvec3(still.white)));
    lag.add(stopsApart(now.white, glm::dvec3(drifting.atOnce().white)));
    cast.add(castError(now.white, glm::dvec3(drifting.atOnce().white)));
  }
  EXPECT_LT(turn.value(), 6.0);
  EXPECT_GT(moved.value(), 0.1);
  EXPECT_LT(lag.value(), 0.1);
  EXPECT_LT(cast.value(), 0.02);
}

}  // namespace
}  // namespace pleinair::scene
