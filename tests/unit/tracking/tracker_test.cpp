#include "pipeline/tracking/pose/tracker.h"

#include <chrono>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/tag_scene.h"

namespace pleinair::tracking {
namespace {

using namespace std::chrono_literals;
using support::poseOf;
using support::SceneTag;

constexpr double kEdge = 0.06;

CameraModel webcam() {
  return {{.fx = 600.0, .fy = 605.0, .cx = 323.0, .cy = 238.0}, {}, {640, 480}};
}

std::vector<SceneTag> table() {
  return {{.id = 4, .edgeMetres = kEdge, .worldFromTag = poseOf({}, {-0.12, -0.06, 0.0})},
          {.id = 9, .edgeMetres = kEdge, .worldFromTag = poseOf({0, 0, 0.5}, {0.1, -0.05, 0.0})},
          {.id = 30, .edgeMetres = kEdge, .worldFromTag = poseOf({0, 0, -1}, {0.02, 0.08, 0.0})}};
}

std::vector<TagMarker> markersOf(const std::vector<SceneTag>& tags) {
  std::vector<TagMarker> markers;
  for (const SceneTag& tag : tags) {
    markers.push_back(
        {.id = tag.id, .edgeMetres = tag.edgeMetres, .worldFromTag = tag.worldFromTag});
  }
  return markers;
}

const glm::dmat4 kView = poseOf({0.4, 0.1, 0.2}, {0.0, 0.01, 0.6});

double degreesBetween(const glm::dmat4& a, const glm::dmat4& b) {
  return glm::degrees(rotationBetweenRad(a, b));
}

TEST(Tracker, WithoutACameraFindsTagsButNoPoses) {
  const auto tags = table();
  const hal::Image image = support::renderTags(webcam(), kView, tags);
  Tracker tracker(std::nullopt, markersOf(tags));
  const TrackingResult result = tracker.track(image.view(), {});
  ASSERT_EQ(result.tags.size(), 3U);
  EXPECT_EQ(result.tags[0].id, 4);
  EXPECT_EQ(result.tags[2].id, 30);
  EXPECT_FALSE(result.cameraFromWorld);
  for (const TrackedTag& tag : result.tags) EXPECT_FALSE(tag.cameraFromTag);
}

TEST(Tracker, SolvesTheWorldFromAllTags) {
  const auto tags = table();
  const hal::Image image = support::renderTags(webcam(), kView, tags, {.noiseSigma = 2.0});
  Tracker tracker(webcam(), markersOf(tags));
  const TrackingResult result = tracker.track(image.view(), {});
  ASSERT_TRUE(result.cameraFromWorld);
  EXPECT_LT(degreesBetween(*result.cameraFromWorld, kView), 0.15);
  EXPECT_LT(glm::distance((*result.cameraFromWorld)[3], kView[3]), 0.001);
  EXPECT_LT(result.worldRmsPx, 0.25);
  EXPECT_GT(result.worldRotationSigmaRad, 0.0);
  EXPECT_LT(glm::degrees(result.worldRotationSigmaRad), 0.5);
  EXPECT_LT(result.worldTranslationSigmaMetres, 0.005);
  ASSERT_EQ(result.tags.size(), 3U);
  for (std::size_t i = 0; i < tags.size(); ++i) {
    ASSERT_TRUE(result.tags[i].cameraFromTag);
    EXPECT_EQ(*result.tags[i].cameraFromTag, *result.cameraFromWorld * tags[i].worldFromTag);
  }
  EXPECT_EQ(tracker.counters().detection.accepted, 3U);
  EXPECT_EQ(tracker.counters().contradictingTags, 0U);
}

TEST(Tracker, MarkersWithoutAPlaceHavePosesButTellNoWorld) {
  const auto tags = table();
  auto markers = markersOf(tags);
  for (TagMarker& marker : markers) marker.worldFromTag.reset();
  markers.pop_back();  // tag 30 is detected, but its size is unknown
  const hal::Image image = support::renderTags(webcam(), kView, tags);
  Tracker tracker(webcam(), markers);
  const TrackingResult result = tracker.track(image.view(), {});
  EXPECT_FALSE(result.cameraFromWorld);
  ASSERT_EQ(result.tags.size(), 3U);
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_TRUE(result.tags[i].cameraFromTag);
    EXPECT_LT(degreesBetween(*result.tags[i].cameraFromTag, kView * tags[i].worldFromTag), 1.0);
  }
  EXPECT_FALSE(result.tags[2].cameraFromTag);
}

TEST(Tracker, FindsAMovedTagWhereItIsAndCountsIt) {
  const auto tags = table();
  auto markers = markersOf(tags);
  markers[1].worldFromTag = *markers[1].worldFromTag * poseOf({}, {0.04, 0.0, 0.0});
  const hal::Image image = support::renderTags(webcam(), kView, tags);
  Tracker tracker(webcam(), markers);
  const TrackingResult result = tracker.track(image.view(), {});
  ASSERT_TRUE(result.cameraFromWorld);
  EXPECT_LT(degreesBetween(*result.cameraFromWorld, kView), 0.3);
  EXPECT_EQ(tracker.counters().contradictingTags, 1U);
  ASSERT_TRUE(result.tags[1].cameraFromTag);
  EXPECT_LT(glm::distance((*result.tags[1].cameraFromTag)[3], (kView * tags[1].worldFromTag)[3]),
            0.005);
}

/// A tag turns towards the front, where its alternatives look alike: earlier frames resolve the
/// ambiguity; after too long a time or a reset it is a guess again.
TEST(Tracker, RemembersForAWhile) {
  SceneTag tag{.id = 4, .edgeMetres = kEdge};
  const std::vector<TagMarker> markers{{.id = 4, .edgeMetres = kEdge}};
  const auto pictureAt = [&](double tilt) {
    tag.worldFromTag = poseOf({tilt, 0.0, 0.0}, {0.1, 0.05, 1.1});
    return support::renderTags(webcam(), glm::dmat4(1.0), {&tag, 1}, {.noiseSigma = 1.0});
  };
  const hal::Image tilted = pictureAt(0.8);
  const hal::Image front = pictureAt(0.15);
  const hal::TimePoint start{};
  const auto choiceOf = [](const TrackingResult& result) { return result.tags[0].choice; };

  Tracker tracker(webcam(), markers);
  EXPECT_EQ(choiceOf(tracker.track(front.view(), start)), AmbiguityResolution::kAmbiguous);
  EXPECT_EQ(choiceOf(tracker.track(tilted.view(), start + 100ms)), AmbiguityResolution::kByError);
  EXPECT_EQ(choiceOf(tracker.track(front.view(), start + 200ms)), AmbiguityResolution::kByPrior);
  EXPECT_EQ(choiceOf(tracker.track(front.view(), start + 600ms)), AmbiguityResolution::kByPrior);
  EXPECT_EQ(choiceOf(tracker.track(front.view(), start + 1200ms)), AmbiguityResolution::kAmbiguous);
  tracker.track(tilted.view(), start + 1300ms);
  tracker.reset();
  EXPECT_EQ(choiceOf(tracker.track(front.view(), start + 1400ms)), AmbiguityResolution::kAmbiguous);
  EXPECT_EQ(tracker.counters().ambiguousTags, 3U);
}

/// A static, ambiguous tag under noise does not flip between its alternatives.
TEST(Tracker, DoesNotFlickerBetweenTwins) {
  const SceneTag tag{
      .id = 4, .edgeMetres = kEdge, .worldFromTag = poseOf({0.1, 0.06, 0.0}, {0.05, 0.02, 1.1})};
  Tracker tracker(webcam(), {{.id = 4, .edgeMetres = kEdge}});
  std::optional<glm::dmat4> last;
  for (int i = 0; i < 20; ++i) {
    const hal::Image image =
        support::renderTags(webcam(), glm::dmat4(1.0), {&tag, 1},
                            {.noiseSigma = 4.0, .noiseSeed = static_cast<std::uint32_t>(i + 1)});
    const TrackingResult result = tracker.track(image.view(), hal::TimePoint(33ms * i));
    ASSERT_EQ(result.tags.size(), 1U);
    ASSERT_TRUE(result.tags[0].cameraFromTag);
    if (last) {
      EXPECT_LT(degreesBetween(*result.tags[0].cameraFromTag, *last), 6.0) << i;
    }
    last = result.tags[0].cameraFromTag;
  }
}

TEST(Tracker, CountsPicturesThatAreTooSmall) {
  Tracker tracker(std::nullopt, {});
  const hal::Image image({.pixelFormat = hal::PixelFormat::kBayerRggb8, .size = {3, 2}});
  EXPECT_TRUE(tracker.track(image.view(), {}).tags.empty());
  EXPECT_EQ(tracker.counters().detection.skippedSmallPicture, 1U);
}

}  // namespace
}  // namespace pleinair::tracking
