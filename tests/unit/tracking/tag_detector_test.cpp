#include "pipeline/tracking/pose/tag_detector.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/tracking/image/luma.h"
#include "tests/support/tag_scene.h"

namespace pleinair::tracking {
namespace {

using support::poseOf;
using support::SceneTag;

CameraModel webcam(hal::FrameSize size = {640, 480}) {
  const double scale = size.width / 640.0;
  return {{.fx = 600.0 * scale,
           .fy = 605.0 * scale,
           .cx = size.width / 2.0 + 3.0,
           .cy = size.height / 2.0 - 2.0},
          {.k1 = -0.15, .k2 = 0.05, .p1 = 0.001, .p2 = -0.0005, .k3 = -0.01},
          size};
}

const glm::dmat4 kIdentity(1.0);

std::vector<int> idsOf(const std::vector<TagDetection>& tags) {
  std::vector<int> ids;
  for (const TagDetection& tag : tags) ids.push_back(tag.id);
  return ids;
}

std::vector<TagDetection> detect(TagDetector& detector, const hal::Image& image,
                                 DetectionCounters& counters) {
  LumaConverter luma;
  const auto tags = detector.detect(luma.convert(image.view()), image.size(), counters);
  return {tags.begin(), tags.end()};
}

std::vector<TagDetection> detect(const hal::Image& image, TagDetectorOptions options = {}) {
  TagDetector detector(std::move(options));
  DetectionCounters counters;
  return detect(detector, image, counters);
}

double worstCornerPx(const TagCornersPx& a, const TagCornersPx& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, glm::distance(a[i], b[i]));
  return worst;
}

/// Checks tagCorners() against the image that the library publishes: on an upright tag, corners
/// begin at the bottom left and go counter-clockwise.
TEST(TagDetector, CornersBeginBottomLeftOfTheUprightTag) {
  const SceneTag tag{.id = 5, .edgeMetres = 0.1, .worldFromTag = poseOf({}, {0.0, 0.0, 0.5})};
  const auto found = detect(support::renderTags(webcam(), kIdentity, {&tag, 1}));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].id, 5);
  EXPECT_EQ(found[0].hamming, 0);
  const TagCornersPx& corners = found[0].corners;
  EXPECT_LT(corners[0].x, corners[1].x);
  EXPECT_LT(corners[3].x, corners[2].x);
  EXPECT_GT(corners[0].y, corners[3].y);
  EXPECT_GT(corners[1].y, corners[2].y);
}

TEST(TagDetector, FindsCornersOfTurnedAndTiltedTags) {
  const CameraModel camera = webcam();
  double sum = 0.0;
  double worst = 0.0;
  int count = 0;
  for (int i = 0; i < 24; ++i) {
    const double turn = 0.2618 * i;
    const double tilt = 0.04 * i;
    const SceneTag tag{.id = 20 + i,
                       .edgeMetres = 0.1,
                       .worldFromTag = poseOf({0.0, 0.0, turn}, {0.08 * std::cos(turn),
                                                                 0.06 * std::sin(turn), 0.55}) *
                                       poseOf({tilt, 0.3 * tilt, 0.0}, {})};
    const auto found = detect(support::renderTags(camera, kIdentity, {&tag, 1}));
    ASSERT_EQ(idsOf(found), std::vector<int>{20 + i});
    const double error = worstCornerPx(
        found[0].corners, support::trueCorners(camera, tag.worldFromTag, tag.edgeMetres));
    sum += error;
    worst = std::max(worst, error);
    ++count;
  }
  RecordProperty("mean_worst_corner_px", std::to_string(sum / count));
  RecordProperty("worst_corner_px", std::to_string(worst));
  std::printf("worst corner of a tag: mean %.3f px, largest %.3f px\n", sum / count, worst);
  EXPECT_LT(sum / count, 0.2);
  EXPECT_LT(worst, 0.5);
}

TEST(TagDetector, GivesTagsByRisingId) {
  std::vector<SceneTag> tags;
  for (const int id : {300, 2, 41}) {
    const auto column = static_cast<double>(tags.size());
    tags.push_back({.id = id,
                    .edgeMetres = 0.05,
                    .worldFromTag = poseOf({}, {-0.1 + 0.1 * column, 0.0, 0.5})});
  }
  TagDetector detector;
  DetectionCounters counters;
  const auto found = detect(detector, support::renderTags(webcam(), kIdentity, tags), counters);
  EXPECT_THAT(idsOf(found), testing::ElementsAre(2, 41, 300));
  EXPECT_EQ(counters, (DetectionCounters{.accepted = 3}));
}

TEST(TagDetector, TakesOneOfTwoTagsOfTheSameId) {
  const std::vector<SceneTag> tags{
      {.id = 7, .edgeMetres = 0.05, .worldFromTag = poseOf({}, {-0.1, 0.0, 0.5})},
      {.id = 7, .edgeMetres = 0.08, .worldFromTag = poseOf({}, {0.1, 0.0, 0.5})}};
  TagDetector detector;
  DetectionCounters counters;
  EXPECT_EQ(detect(detector, support::renderTags(webcam(), kIdentity, tags), counters).size(), 1U);
  EXPECT_EQ(counters, (DetectionCounters{.accepted = 1, .rejectedDuplicate = 1}));
}

TEST(TagDetector, FindsTagsInSmallPictures) {
  for (const hal::FrameSize size :
       {hal::FrameSize{320, 240}, hal::FrameSize{161, 97}, hal::FrameSize{48, 40}}) {
    const CameraModel camera = webcam(size);
    const SceneTag tag{.id = 3, .edgeMetres = 0.1, .worldFromTag = poseOf({}, {0.0, 0.0, 0.24})};
    const auto found = detect(support::renderTags(camera, kIdentity, {&tag, 1}));
    ASSERT_EQ(idsOf(found), std::vector<int>{3}) << size.width;
    EXPECT_LT(worstCornerPx(found[0].corners, support::trueCorners(camera, tag.worldFromTag, 0.1)),
              0.6);
  }
}

TEST(TagDetector, ReducesLargePicturesOnly) {
  EXPECT_EQ(decimationFor({320, 240}), 1.0);
  EXPECT_EQ(decimationFor({640, 480}), 1.5);
  EXPECT_EQ(decimationFor({720, 1280}), 2.0);
  EXPECT_EQ(decimationFor({1920, 1080}), 3.0);
  const CameraModel camera = webcam({48, 40});
  const SceneTag tag{.id = 3, .edgeMetres = 0.1, .worldFromTag = poseOf({}, {0.0, 0.0, 0.24})};
  const auto found = detect(support::renderTags(camera, kIdentity, {&tag, 1}), {.decimation = 4.0});
  EXPECT_EQ(idsOf(found), std::vector<int>{3});
}

TEST(TagDetector, FindsTagsOfLowContrast) {
  const SceneTag tag{.id = 12, .edgeMetres = 0.1, .worldFromTag = poseOf({}, {0.0, 0.0, 0.6})};
  const auto at = [&](double white) {
    return idsOf(detect(support::renderTags(
        webcam(), kIdentity, {&tag, 1},
        {.black = 40.0, .white = white, .background = 45.0, .noiseSigma = 2.0})));
  };
  EXPECT_EQ(at(70.0), std::vector<int>{12});
  EXPECT_TRUE(at(50.0).empty());
}

TEST(TagDetector, SkipsPicturesOfFewPixels) {
  TagDetector detector;
  DetectionCounters counters;
  for (const hal::FrameSize size :
       {hal::FrameSize{1, 1}, hal::FrameSize{31, 400}, hal::FrameSize{400, 2}}) {
    const hal::Image image({.pixelFormat = hal::PixelFormat::kGrey8, .size = size});
    EXPECT_TRUE(detect(detector, image, counters).empty());
  }
  EXPECT_EQ(counters, (DetectionCounters{.skippedSmallPicture = 3}));
}

TEST(TagDetector, FindsNothingInNoiseAndFlatPictures) {
  TagDetector detector;
  DetectionCounters counters;
  for (const double sigma : {0.0, 60.0}) {
    const auto image = support::renderTags(webcam(), kIdentity, {}, {.noiseSigma = sigma});
    EXPECT_TRUE(detect(detector, image, counters).empty());
  }
}

/// An image whose stride is larger than its width.
TEST(TagDetector, KeepsToTheStride) {
  const SceneTag tag{.id = 9, .edgeMetres = 0.1, .worldFromTag = poseOf({}, {0.0, 0.0, 0.5})};
  const hal::Image image = support::renderTags(webcam({320, 240}), kIdentity, {&tag, 1});
  constexpr std::size_t kStride = 333;
  std::vector<std::uint8_t> spread(kStride * 239 + 320, 200);
  for (int y = 0; y < 240; ++y) {
    std::ranges::copy(image.view().row(0, y),
                      spread.begin() + static_cast<std::ptrdiff_t>(kStride) * y);
  }
  TagDetector detector;
  DetectionCounters counters;
  const auto found =
      detector.detect({.bytes = spread, .strideBytes = kStride}, {320, 240}, counters);
  const auto packed = detect(image);
  ASSERT_EQ(found.size(), 1U);
  ASSERT_EQ(packed.size(), 1U);
  EXPECT_LT(worstCornerPx(found[0].corners, packed[0].corners), 1e-9);
}

TEST(TagDetector, SaysWhichFamiliesItKnows) {
  EXPECT_TRUE(checkTagFamily("tag36h11"));
  const auto refused = checkTagFamily("tag36h12", "marker.family");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message(),
            "marker.family: unknown tag family 'tag36h12'; use one of tag36h11, tag36h10, tag25h9, "
            "tag16h5, tagCircle21h7, tagCircle49h12, tagStandard41h12, tagStandard52h13, "
            "tagCustom48h12");
  EXPECT_THROW(TagDetector({.family = ""}), hal::Failure);
  EXPECT_NO_THROW(TagDetector({.family = "tag25h9"}));
}

TEST(SelectDetections, CountsWhatItLeavesOutByReason) {
  std::vector<TagDetection> tags{{.id = 4, .hamming = 0, .decisionMargin = 50.0},
                                 {.id = 1, .hamming = 1, .decisionMargin = 30.0},
                                 {.id = 4, .hamming = 0, .decisionMargin = 70.0},
                                 {.id = 3, .hamming = 0, .decisionMargin = 9.0}};
  DetectionCounters counters{.accepted = 10};
  selectDetections(tags, {.minDecisionMargin = 10.0}, counters);
  EXPECT_THAT(idsOf(tags), testing::ElementsAre(1, 4));
  EXPECT_EQ(tags[1].decisionMargin, 70.0);
  EXPECT_EQ(counters,
            (DetectionCounters{.accepted = 12, .rejectedMargin = 1, .rejectedDuplicate = 1}));
}

}  // namespace
}  // namespace pleinair::tracking
