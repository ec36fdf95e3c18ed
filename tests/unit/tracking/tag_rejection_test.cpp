#include <algorithm>
#include <chrono>
#include <cstdint>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "pipeline/tracking/pose/tracker.h"
#include "tests/support/tag_scene.h"

namespace pleinair::tracking {
namespace {

using namespace std::chrono_literals;
using support::poseOf;
using support::SceneTag;

constexpr double kEdge = 0.06;

CameraModel webcam() {
  return {{.fx = 600.0, .fy = 600.0, .cx = 320.0, .cy = 240.0}, {}, {640, 480}};
}

hal::Image picture(const std::vector<SceneTag>& tags,
                   const support::TagPictureOptions& options = {.noiseSigma = 1.0}) {
  return support::renderTags(webcam(), glm::dmat4(1.0), tags, options);
}

SceneTag tagAt(int id, const glm::dvec3& position) {
  return {.id = id, .edgeMetres = kEdge, .worldFromTag = poseOf({0.5, 0.1, 0.2}, position)};
}

std::uint32_t countOf(const TrackingCounters& counters, std::string_view reason) {
  const auto all = rejections(counters);
  const auto found = std::ranges::find(all, reason, &Rejection::reason);
  return found == all.end() ? 999 : found->count;
}

/// Sum of all rejections; reasons that are only recorded do not count.
std::uint32_t sumOf(const TrackingCounters& counters) {
  std::uint32_t sum = 0;
  for (const Rejection& each : rejections(counters)) {
    if (each.reason != "ambiguous" && each.reason != "contradicting") sum += each.count;
  }
  return sum;
}

TEST(TagRejection, NothingIsCountedWhereAllIsWell) {
  Tracker tracker(webcam(), {{.id = 4, .edgeMetres = kEdge}});
  const hal::Image image = picture({tagAt(4, {0, 0, 0.6})});
  EXPECT_TRUE(tracker.track(image.view(), {}).tags[0].cameraFromTag);
  EXPECT_EQ(sumOf(tracker.counters()), 0U);
}

TEST(TagRejection, AnIdThatIsNotInTheSceneHasNoPose) {
  Tracker tracker(webcam(), {{.id = 4, .edgeMetres = kEdge}});
  const hal::Image image = picture({tagAt(9, {0, 0, 0.6})});
  const TrackingResult result = tracker.track(image.view(), {});
  ASSERT_EQ(result.tags.size(), 1U);
  EXPECT_FALSE(result.tags[0].cameraFromTag);
  EXPECT_EQ(countOf(result.counted, "unknown"), 1U);
  EXPECT_EQ(sumOf(result.counted), 1U);
}

TEST(TagRejection, AMirroredPictureIsToldOnceASecond) {
  hal::Image image = picture({tagAt(4, {0, 0, 0.6})});
  for (int y = 0; y < 480; ++y) std::ranges::reverse(image.row(0, y));
  Tracker tracker(webcam(), {{.id = 4, .edgeMetres = kEdge}});
  for (int i = 0; i < 40; ++i) {
    EXPECT_TRUE(tracker.track(image.view(), hal::TimePoint(33ms * i)).tags.empty());
  }
  EXPECT_EQ(countOf(tracker.counters(), "mirrored"), 2U);
  EXPECT_EQ(sumOf(tracker.counters()), 2U);
}

/// Two tags with the same id: the known one is kept, although the other is nearer and clearer.
TEST(TagRejection, OfDuplicatesTheOneThatWasThereGoesOn) {
  Tracker tracker(webcam(), {{.id = 4, .edgeMetres = kEdge}});
  const glm::dvec3 place(-0.15, 0.0, 0.8);
  const hal::Image alone = picture({tagAt(4, place)});
  const hal::Image both = picture({tagAt(4, place), tagAt(4, {0.1, 0.0, 0.45})});
  const auto positionIn = [&](const hal::Image& image, int frame) {
    const TrackingResult result = tracker.track(image.view(), hal::TimePoint(200ms * frame));
    EXPECT_EQ(result.tags.size(), 1U);
    return glm::dvec3((*result.tags[0].cameraFromTag)[3]);
  };
  EXPECT_LT(glm::distance(positionIn(alone, 0), place), 0.01);
  for (int i = 1; i < 4; ++i) EXPECT_LT(glm::distance(positionIn(both, i), place), 0.01);
  EXPECT_EQ(countOf(tracker.counters(), "duplicate"), 3U);

  tracker.reset();  // nothing is known: the clearer one wins
  EXPECT_GT(glm::distance(positionIn(both, 5), place), 0.1);
}

TEST(TagRejection, AVerySmallTagHasNoPose) {
  Tracker tracker(webcam(), {{.id = 4, .edgeMetres = kEdge}}, {.minEdgePx = 40.0});
  const auto edgeAt = [&](double metres) {
    const hal::Image image = picture(
        {{.id = 4, .edgeMetres = kEdge, .worldFromTag = poseOf({0.0, 0.0, 0.1}, {0, 0, metres})}});
    tracker.reset();
    return tracker.track(image.view(), {});
  };
  EXPECT_TRUE(edgeAt(0.85).tags[0].cameraFromTag);  // 42 px
  EXPECT_EQ(countOf(tracker.counters(), "small"), 0U);
  const TrackingResult small = edgeAt(0.95);  // 38 px
  ASSERT_EQ(small.tags.size(), 1U);
  EXPECT_FALSE(small.tags[0].cameraFromTag);
  EXPECT_EQ(countOf(tracker.counters(), "small"), 1U);
}

/// A tag with a clear border whose bits have faded to a third of their contrast.
TEST(TagRejection, ATagWithFaintBitsIsNone) {
  TrackerOptions options;
  options.detector.minDecisionMargin = 60.0;
  Tracker tracker(webcam(), {{.id = 4, .edgeMetres = kEdge}}, options);
  hal::Image image =
      picture({{.id = 4, .edgeMetres = kEdge, .worldFromTag = poseOf({}, {0.0, 0.0, 0.5})}});
  EXPECT_EQ(tracker.track(image.view(), {}).tags.size(), 1U);
  EXPECT_EQ(countOf(tracker.counters(), "faint"), 0U);
  constexpr int kHalfInside = 26;  // of 36 px to the border's outer edge
  for (int y = 240 - kHalfInside; y < 240 + kHalfInside; ++y) {
    for (std::uint8_t& value : image.row(0, y).subspan(320 - kHalfInside, 2 * kHalfInside)) {
      value = static_cast<std::uint8_t>(125 + (value - 125) / 3);
    }
  }
  tracker.reset();
  EXPECT_TRUE(tracker.track(image.view(), hal::TimePoint(33ms)).tags.empty());
  EXPECT_EQ(countOf(tracker.counters(), "faint"), 1U);
}

}  // namespace
}  // namespace pleinair::tracking
