#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "pipeline/tracking/pose/tracker.h"
#include "pipeline/tracking/pose/twist.h"
#include "tests/support/tag_scene.h"

namespace pleinair::tracking {
namespace {

using namespace std::chrono_literals;
using support::poseOf;
using support::SceneTag;

constexpr double kEdge = 0.06;
constexpr int kId = 4;

CameraModel webcam() {
  return {{.fx = 600.0, .fy = 605.0, .cx = 323.0, .cy = 238.0}, {}, {640, 480}};
}

/// A tag on a table; other tags, unknown to the tracker, serve as texture.
std::vector<SceneTag> table(bool hasTag) {
  std::vector<SceneTag> tags;
  if (hasTag) tags.push_back({.id = kId, .edgeMetres = kEdge});
  int id = 100;
  for (int i = -2; i <= 2; ++i) {
    for (int k = -1; k <= 1; ++k) {
      if (i == 0 && k == 0) continue;
      tags.push_back({.id = id++,
                      .edgeMetres = 0.05,
                      .worldFromTag = poseOf({0, 0, 0.4 * i + k}, {0.1 * i, 0.11 * k, 0.0})});
    }
  }
  return tags;
}

glm::dmat4 viewAt(int frame) {
  return poseOf({0.5, 0.1 + 0.004 * frame, 0.2}, {0.002 * frame - 0.02, 0.01, 0.6});
}

/// Frames at 30 per second of a camera that moves over the table.
class CarriedTag : public testing::Test {
 protected:
  TrackingResult show(Tracker& tracker, bool hasTag) {
    const hal::Image image =
        support::renderTags(webcam(), viewAt(frame_), table(hasTag),
                            {.samplesPerSide = 3,
                             .noiseSigma = 2.0,
                             .noiseSeed = static_cast<std::uint32_t>(frame_ + 1)});
    const TrackingResult result = tracker.track(image.view(), hal::TimePoint(33ms * frame_));
    ++frame_;
    return result;
  }
  static const TrackedTag* tagOf(const TrackingResult& result) {
    const auto found = std::ranges::find(result.tags, kId, &TrackedTag::id);
    return found == result.tags.end() || !found->cameraFromTag ? nullptr : &*found;
  }
  /// RMS error (px) of the corners of a cube on the tag, against the truth of the last frame.
  double errorPx(const TrackedTag& tag) const {
    return cubeDistance(*tag.cameraFromTag, viewAt(frame_ - 1));
  }
  static double cubeDistance(const glm::dmat4& a, const glm::dmat4& b) {
    double sum = 0.0;
    for (const double height : {0.0, kEdge}) {
      for (glm::dvec3 point : tagCorners(kEdge)) {
        point.z = -height;
        const glm::dvec2 apart = webcam().project(glm::dvec3(a * glm::dvec4(point, 1.0))) -
                                 webcam().project(glm::dvec3(b * glm::dvec4(point, 1.0)));
        sum += glm::dot(apart, apart) / 8.0;
      }
    }
    return std::sqrt(sum);
  }

  int frame_ = 0;
};

TEST_F(CarriedTag, StaysWhereItIsWhileHiddenAndDoesNotJumpAtItsReturn) {
  Tracker tracker(webcam(), {{.id = kId, .edgeMetres = kEdge}});
  for (int i = 0; i < 5; ++i) show(tracker, true);
  double lastSigma = 0.0;
  for (int i = 0; i < 12; ++i) {
    const TrackingResult result = show(tracker, false);
    const TrackedTag* const tag = tagOf(result);
    ASSERT_NE(tag, nullptr) << i;
    EXPECT_EQ(tag->source, PoseSource::kCarried);
    EXPECT_LT(errorPx(*tag), 1.0) << i;
    const double sigma = tag->covariance[21] + tag->covariance[28] + tag->covariance[35];
    if (i == 11) {
      EXPECT_GT(sigma, lastSigma) << "it grows";
    }
    if (i == 0) lastSigma = sigma;
    const auto truth = support::trueCorners(webcam(), viewAt(frame_ - 1), kEdge);
    EXPECT_LT(glm::distance(tag->corners[0], truth[0]), 1.0);
  }
  const TrackingResult back = show(tracker, true);
  ASSERT_NE(tagOf(back), nullptr);
  EXPECT_EQ(tagOf(back)->source, PoseSource::kSeen);
  EXPECT_LT(errorPx(*tagOf(back)), 1.0);
}

TEST_F(CarriedTag, IsLostWithoutCarrying) {
  Tracker tracker(webcam(), {{.id = kId, .edgeMetres = kEdge}},
                  {.poses = {.filters = true, .carries = false}});
  for (int i = 0; i < 5; ++i) ASSERT_NE(tagOf(show(tracker, true)), nullptr);
  EXPECT_EQ(tagOf(show(tracker, false)), nullptr);
}

TEST_F(CarriedTag, IsDroppedAfterHalfASecond) {
  Tracker tracker(webcam(), {{.id = kId, .edgeMetres = kEdge}});
  for (int i = 0; i < 3; ++i) show(tracker, true);
  const int lastSeen = frame_ - 1;
  for (int i = 0; i < 18; ++i) {
    const bool isCarried = tagOf(show(tracker, false)) != nullptr;
    EXPECT_EQ(isCarried, (frame_ - 1 - lastSeen) * 33ms <= 500ms) << i;
  }
}

TEST_F(CarriedTag, CarriesTheWorldToo) {
  Tracker tracker(webcam(), {{.id = kId, .edgeMetres = kEdge, .worldFromTag = glm::dmat4(1.0)}});
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(show(tracker, true).worldSource, PoseSource::kSeen);
  }
  for (int i = 0; i < 8; ++i) {
    const TrackingResult result = show(tracker, false);
    ASSERT_TRUE(result.cameraFromWorld) << i;
    EXPECT_EQ(result.worldSource, PoseSource::kCarried);
    EXPECT_LT(cubeDistance(*result.cameraFromWorld, viewAt(frame_ - 1)), 1.0) << i;
  }
}

TEST_F(CarriedTag, IsForgottenAtAReset) {
  Tracker tracker(webcam(), {{.id = kId, .edgeMetres = kEdge}});
  for (int i = 0; i < 3; ++i) show(tracker, true);
  tracker.reset();
  EXPECT_EQ(tagOf(show(tracker, false)), nullptr);
}

/// A large error at the tag's return is blended: the drawn pose moves in steps.
TEST(TargetPose, BlendsAwayWhatWasWrongAtAReturn) {
  const CameraModel camera = webcam();
  const auto points = tagCorners(kEdge);
  const auto estimate = [](double x) {
    return PoseEstimate{.cameraFromTarget = poseOf({0.4, 0.0, 0.0}, {x, 0.0, 0.6}),
                        .covariance = isotropic(0.001, 0.0002)};
  };
  TargetPose pose;
  hal::TimePoint now{};
  pose.see(camera, {}, estimate(0.0), points, now);
  for (int i = 0; i < 5; ++i) {
    now += 33ms;
    pose.predict(camera, {}, now);
    pose.miss(now);
  }
  double last = pose.drawn(now)->cameraFromTarget[3].x;
  double largestStep = 0.0;
  for (int i = 0; i < 8; ++i) {
    now += 33ms;
    pose.predict(camera, {}, now);
    pose.see(camera, {}, estimate(0.01), points, now);
    const double x = pose.drawn(now)->cameraFromTarget[3].x;
    largestStep = std::max(largestStep, std::abs(x - last));
    last = x;
  }
  EXPECT_LT(largestStep, 0.006) << "it was 0.01 off";
  EXPECT_NEAR(last, 0.01, 0.0005);
}

/// A tag moved by hand in front of a static background is followed at once.
TEST(MovedTag, DoesNotStayWithTheBackground) {
  Tracker tracker(webcam(), {{.id = kId, .edgeMetres = kEdge}});
  std::vector<SceneTag> tags = table(true);
  std::rotate(tags.begin(), tags.begin() + 1, tags.end());  // draw the moved tag above the others
  for (int i = 0; i < 24; ++i) {
    const double aside = i < 6 ? 0.0 : 0.006 * (i - 5);
    tags.back().worldFromTag = poseOf({}, {aside, 0.0, 0.0});
    const hal::Image image = support::renderTags(
        webcam(), viewAt(0), tags,
        {.samplesPerSide = 3, .noiseSigma = 2.0, .noiseSeed = 1U + static_cast<std::uint32_t>(i)});
    const TrackingResult result = tracker.track(image.view(), hal::TimePoint(33ms * i));
    const auto tag = std::ranges::find(result.tags, kId, &TrackedTag::id);
    ASSERT_NE(tag, result.tags.end()) << i;
    ASSERT_TRUE(tag->cameraFromTag) << i;
    const glm::dmat4 truth = viewAt(0) * tags.back().worldFromTag;
    EXPECT_LT(glm::distance(webcam().project(glm::dvec3((*tag->cameraFromTag)[3])),
                            webcam().project(glm::dvec3(truth[3]))),
              1.0)
        << i;
  }
}

}  // namespace
}  // namespace pleinair::tracking
