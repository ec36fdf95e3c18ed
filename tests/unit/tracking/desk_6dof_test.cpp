#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "hal/cameras/recording/recording.h"
#include "pipeline/tracking/pose/pose_refinement.h"
#include "pipeline/tracking/pose/tracker.h"
#include "tests/unit/tracking/desk_sequence.h"

namespace pleinair::tracking {
namespace {

double percentile(std::vector<double> values, double part) {
  if (values.empty()) return std::nan("");
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

struct PoseErrors {
  std::vector<double> rotationDegrees;
  std::vector<double> translationMm;

  void add(const glm::dmat4& measured, const glm::dmat4& truth) {
    rotationDegrees.push_back(glm::degrees(rotationBetweenRad(measured, truth)));
    translationMm.push_back(1000.0 * glm::distance(glm::dvec3(measured[3]), glm::dvec3(truth[3])));
  }
  void expectBelow(double degreesMedian, double degrees95th, double mmMedian, double mm95th) const {
    EXPECT_LT(percentile(rotationDegrees, 0.5), degreesMedian);
    EXPECT_LT(percentile(rotationDegrees, 0.95), degrees95th);
    EXPECT_LT(percentile(translationMm, 0.5), mmMedian);
    EXPECT_LT(percentile(translationMm, 0.95), mm95th);
  }
  void report(const std::string& name) const {
    const auto record = [&](const char* what, const std::vector<double>& values) {
      const std::string median = std::to_string(percentile(values, 0.5));
      const std::string most = std::to_string(percentile(values, 0.95));
      testing::Test::RecordProperty(name + "_" + what + "_median", median);
      testing::Test::RecordProperty(name + "_" + what + "_95th", most);
      std::printf("%-14s %-12s median %s, 95th percentile %s (%zu poses)\n", name.c_str(), what,
                  median.c_str(), most.c_str(), values.size());
    };
    record("rotation_deg", rotationDegrees);
    record("position_mm", translationMm);
  }
};

class Desk6dof : public testing::Test {
 protected:
  void SetUp() override {
    if (!hasDeskSequence()) GTEST_SKIP() << "no sequence desk_6dof in " PLEINAIR_SHARED_DATA;
  }

  /// Tracks every frame of the movie.
  static void track(
      const DeskSequence& desk, Tracker& tracker,
      const std::function<void(const TrackingResult&, const DeskSequence::Frame&)>& judge) {
    hal::SteppedClock clock;
    const auto movie = hal::openRecording(desk.moviePath, clock);
    ASSERT_TRUE(movie->start({}));
    std::size_t index = 0;
    for (hal::NextFrame next = movie->next(hal::kNoDeadline);
         std::holds_alternative<hal::CapturedFrame>(next);
         next = movie->next(hal::kNoDeadline), ++index) {
      const auto& frame = std::get<hal::CapturedFrame>(next);
      ASSERT_LT(index, desk.frames.size());
      judge(tracker.track(frame.image.map().view(), frame.captureTime), desk.frames[index]);
    }
    EXPECT_EQ(index, desk.frames.size());
  }
};

/// Whether the whole black square is in the picture.
bool isInside(const TagCornersPx& corners, hal::FrameSize size) {
  constexpr double kMarginPx = 6.0;
  return std::ranges::all_of(corners, [&](const glm::dvec2& px) {
    return px.x > kMarginPx && px.y > kMarginPx && px.x < size.width - kMarginPx &&
           px.y < size.height - kMarginPx;
  });
}

TEST_F(Desk6dof, TruthIsInOurConventions) {
  const DeskSequence desk = readDeskSequence();
  for (const DeskSequence::Frame& frame : desk.frames) {
    for (const TagMarker& marker : desk.markers) {
      const glm::dmat4 cameraFromTag = frame.cameraFromWorld * *marker.worldFromTag;
      EXPECT_GT(cameraFromTag[2].z, 0.0) << "the tag faces the camera";
      const auto points = tagCorrespondences(frame.corners.at(marker.id), marker.edgeMetres);
      EXPECT_LT(std::sqrt(squaredErrorPx(desk.camera, points, cameraFromTag) / 4.0), 0.01);
    }
  }
}

TEST_F(Desk6dof, EachTagByItself) {
  const DeskSequence desk = readDeskSequence();
  std::vector<TagMarker> markers = desk.markers;
  for (TagMarker& marker : markers) marker.worldFromTag.reset();
  Tracker tracker(desk.camera, markers);
  std::map<int, PoseErrors> errors;
  PoseErrors allErrors;
  std::vector<double> cornerErrors;
  glm::dvec2 shift(0.0);
  std::map<int, int> visible;
  std::map<int, int> found;
  int visibleCount = 0;
  int foundCount = 0;
  int falseCount = 0;
  track(desk, tracker, [&](const TrackingResult& result, const DeskSequence::Frame& frame) {
    EXPECT_FALSE(result.cameraFromWorld);
    for (const auto& [id, corners] : frame.corners) {
      if (!isInside(corners, desk.camera.imageSize())) continue;
      ++visible[id];
      ++visibleCount;
      if (std::ranges::find(result.tags, id, &TrackedTag::id) != result.tags.end()) {
        ++found[id];
        ++foundCount;
      }
    }
    for (const TrackedTag& tag : result.tags) {
      const auto marker = std::ranges::find(desk.markers, tag.id, &TagMarker::id);
      if (marker == desk.markers.end()) {
        ++falseCount;
        continue;
      }
      for (std::size_t i = 0; i < 4; ++i) {
        const glm::dvec2 error = tag.corners[i] - frame.corners.at(tag.id)[i];
        cornerErrors.push_back(glm::length(error));
        shift += error;
      }
      ASSERT_TRUE(tag.cameraFromTag);
      const glm::dmat4 truth = frame.cameraFromWorld * *marker->worldFromTag;
      errors[tag.id].add(*tag.cameraFromTag, truth);
      allErrors.add(*tag.cameraFromTag, truth);
    }
  });
  for (const auto& [id, each] : errors) each.report("tag_" + std::to_string(id));
  allErrors.report("tags");
  shift /= static_cast<double>(cornerErrors.size());
  std::printf("corners: median %.3f, 95th percentile %.3f px, mean shift (%.3f, %.3f) px\n",
              percentile(cornerErrors, 0.5), percentile(cornerErrors, 0.95), shift.x, shift.y);
  for (const auto& [id, count] : visible) {
    std::printf("tag %d: found in %d of %d\n", id, found[id], count);
  }
  const double rate = static_cast<double>(foundCount) / visibleCount;
  std::printf("detection rate %.4f of %d\n", rate, visibleCount);
  EXPECT_EQ(falseCount, 0);
  EXPECT_GT(rate, 0.99);
  EXPECT_LT(percentile(cornerErrors, 0.5), 0.13);
  EXPECT_LT(percentile(cornerErrors, 0.95), 0.33);
  EXPECT_LT(glm::length(shift), 0.02);
  allErrors.expectBelow(0.19, 0.6, 0.57, 3.0);
}

TEST_F(Desk6dof, AllTagsTogether) {
  const DeskSequence desk = readDeskSequence();
  Tracker tracker(desk.camera, desk.markers);
  PoseErrors errors;
  std::vector<double> sigmas;
  std::size_t frames = 0;
  track(desk, tracker, [&](const TrackingResult& result, const DeskSequence::Frame& frame) {
    ++frames;
    if (!result.cameraFromWorld) return;
    errors.add(*result.cameraFromWorld, frame.cameraFromWorld);
    sigmas.push_back(glm::degrees(result.worldRotationSigmaRad));
  });
  errors.report("world");
  std::printf("predicted rotation sigma: median %.4f deg\n", percentile(sigmas, 0.5));
  EXPECT_EQ(errors.rotationDegrees.size(), frames);
  errors.expectBelow(0.019, 0.05, 0.085, 0.33);
  EXPECT_EQ(tracker.counters().contradictingTags, 0U);
}

}  // namespace
}  // namespace pleinair::tracking
