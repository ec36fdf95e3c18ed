#include <chrono>
#include <map>
#include <memory>

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

#include "hal/cameras/synthetic/world/world.h"
#include "tests/unit/hal/synthetic/captured.h"
#include "tests/unit/hal/synthetic/ray_oracle.h"

namespace pleinair::hal::synthetic {
namespace {

using Corners = std::array<glm::dvec2, 4>;

/// The real detector, at full resolution.
class Detector {
 public:
  Detector() {
    apriltag_detector_add_family(detector_.get(), family_.get());
    detector_->quad_decimate = 1;
  }

  std::map<int, Corners> detect(const Image& rgb) {
    const FrameSize size = rgb.size();
    std::vector<std::uint8_t> grey(static_cast<std::size_t>(size.pixels()));
    const auto bytes = bytesOf(rgb);
    for (std::size_t i = 0; i < grey.size(); ++i) {
      const double luma =
          0.299 * bytes[3 * i] + 0.587 * bytes[3 * i + 1] + 0.114 * bytes[3 * i + 2];
      grey[i] = static_cast<std::uint8_t>(luma + 0.5);
    }
    image_u8_t picture{size.width, size.height, size.width, grey.data()};
    const std::unique_ptr<zarray_t, decltype(&apriltag_detections_destroy)> found(
        apriltag_detector_detect(detector_.get(), &picture), apriltag_detections_destroy);
    std::map<int, Corners> corners;
    for (int i = 0; i < zarray_size(found.get()); ++i) {
      apriltag_detection_t* one = nullptr;
      zarray_get(found.get(), i, static_cast<void*>(&one));
      Corners& of = corners[one->id];
      for (std::size_t corner = 0; corner < 4; ++corner) {
        of[corner] = {one->p[corner][0], one->p[corner][1]};
      }
    }
    return corners;
  }

 private:
  std::unique_ptr<apriltag_family_t, decltype(&tag36h11_destroy)> family_{tag36h11_create(),
                                                                          tag36h11_destroy};
  std::unique_ptr<apriltag_detector_t, decltype(&apriltag_detector_destroy)> detector_{
      apriltag_detector_create(), apriltag_detector_destroy};
};

/// The detector's accuracy on the first frames of a shot.
struct Score {
  std::map<int, int> timesVisible, timesFound;
  int corners = 0;
  int notInSight = 0;
  double sum = 0, worst = 0;
};

Score scoreOf(const SyntheticOptions& options, int count) {
  const std::vector<Image> frames = capturedFrames(options, count);
  SteppedClock clock;
  const SyntheticCamera camera(options, clock);
  Detector detector;
  Score score;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::map<int, Corners> found = detector.detect(frames[i]);
    for (const TagTruth& truth : camera.truth(i).tags) {
      const auto detected = found.find(truth.tag.id);
      if (detected != found.end() && !truth.isVisible) ++score.notInSight;
      if (!truth.isVisible) continue;
      ++score.timesVisible[truth.tag.id];
      EXPECT_NE(detected, found.end()) << "tag " << truth.tag.id << " in frame " << i;
      if (detected == found.end()) continue;
      ++score.timesFound[truth.tag.id];
      for (std::size_t corner = 0; corner < 4; ++corner, ++score.corners) {
        const double error = glm::distance(detected->second[corner], truth.cornersPx[corner]);
        EXPECT_LT(error, 0.8) << "tag " << truth.tag.id << " corner " << corner << " frame " << i;
        score.sum += error;
        score.worst = std::max(score.worst, error);
      }
    }
    EXPECT_LE(found.size(), benchTags().size());
  }
  return score;
}

TEST(SyntheticTags, AreFoundWhereTheTruthSays) {
  const Score score = scoreOf({.framePeriod = std::chrono::milliseconds(1370)}, 12);
  EXPECT_EQ(score.timesFound.size(), benchTags().size()) << "every tag comes into view";
  EXPECT_LT(score.sum / score.corners, 0.32);
  RecordProperty("meanCornerErrorPx", std::to_string(score.sum / score.corners));
  RecordProperty("worstCornerErrorPx", std::to_string(score.worst));
}

TEST(SyntheticTags, AreFoundWhereTheTruthSaysUnderARollingShutter) {
  const Score score = scoreOf({.framePeriod = std::chrono::milliseconds(370),
                               .shot = SyntheticShot::kPan,
                               .rowTime = std::chrono::microseconds(60)},
                              6);
  EXPECT_LT(score.sum / score.corners, 0.32);
}

TEST(SyntheticTags, AreHiddenByTheArmForAWhile) {
  SteppedClock clock;
  const SyntheticCamera camera({.shot = SyntheticShot::kOccluder}, clock);
  const auto isVisible = [&camera](std::uint64_t frame, std::size_t tag) {
    const TagTruth truth = camera.truth(frame).tags[tag];
    EXPECT_TRUE(truth.isInside);
    return truth.isVisible;
  };
  EXPECT_TRUE(isVisible(0, 0));
  EXPECT_FALSE(isVisible(75, 0));
  EXPECT_TRUE(isVisible(150, 0));
  EXPECT_TRUE(isVisible(75, 1)) << "the toolbox's tag stays in sight";
}

/// Whether the oracle finds another surface before the tag at any of many points of the tag.
bool isHiddenToTheOracle(const CameraView& view, const BodyPoses& bodies, const BenchTag& tag) {
  const double half = tag.edgeMetres * 10 / 16;
  for (int row = 0; row <= 40; ++row) {
    for (int column = 0; column <= 40; ++column) {
      const glm::dvec4 onTag(half * (column / 20.0 - 1), half * (row / 20.0 - 1), 0, 1);
      const glm::dvec3 world(tag.worldFromTag * onTag);
      const auto hit = oracleHit(workbenchGeometry(), view, bodies, *view.project(world));
      if (!hit || glm::distance(hit->world, world) > 2e-4) return true;
    }
  }
  return false;
}

TEST(SyntheticTags, AreHiddenWhenRaysSaySo) {
  SteppedClock clock;
  const SyntheticCamera camera({.shot = SyntheticShot::kOccluder}, clock);
  const Motion motion(SyntheticShot::kOccluder, 1);
  int hidden = 0;
  for (const std::uint64_t frame : {0U, 33U, 36U, 75U}) {
    const GroundTruth truth = camera.truth(frame);
    const CameraView view{truth.intrinsics, truth.cameraFromWorld};
    const BodyPoses bodies = motion.bodies(static_cast<double>(frame) * 0.033333333);
    for (const TagTruth& tag : truth.tags) {
      if (!tag.isInside) continue;
      EXPECT_EQ(tag.isVisible, !isHiddenToTheOracle(view, bodies, tag.tag))
          << "tag " << tag.tag.id << " in frame " << frame;
      hidden += tag.isVisible ? 0 : 1;
    }
  }
  EXPECT_GT(hidden, 0);
}

TEST(SyntheticTags, StickToSurfacesInRightHandedFrames) {
  const std::vector<BenchTag> tags = benchTags();
  ASSERT_EQ(tags.size(), 5u);
  for (std::size_t i = 0; i < tags.size(); ++i) {
    EXPECT_EQ(tags[i].id, static_cast<int>(i));
    EXPECT_EQ(tags[i].family, "tag36h11");
    const glm::dmat4& pose = tags[i].worldFromTag;
    EXPECT_NEAR(glm::determinant(glm::dmat3(pose)), 1, 1e-12);
    // From its front, the tag's middle is the first surface.
    const glm::dvec3 middle(pose[3]);
    const Ray towards{middle - 0.01 * glm::dvec3(pose[2]), glm::dvec3(pose[2])};
    const auto met = workbenchGeometry().firstAlong(towards, BodyPoses());
    ASSERT_TRUE(met);
    EXPECT_LT(glm::distance(met->point, middle), 1e-9) << "tag " << i;
  }
}

TEST(SyntheticTags, LeaveRoomForAModelOnTheFirst) {
  const BenchTag tag = benchTags()[0];
  EXPECT_EQ(glm::dvec3(tag.worldFromTag[2]), glm::dvec3(0, 0, -1)) << "face up";
  for (int i = -10; i <= 10; ++i) {
    for (int j = -10; j <= 10; ++j) {
      const glm::dvec3 from(0.015 * i, 0.010 * j, 0.12);
      const auto met = workbenchGeometry().firstAlong({from, {0, 0, -1}}, BodyPoses());
      ASSERT_TRUE(met);
      EXPECT_NEAR(met->point.z, 0, 1e-9) << from.x << " " << from.y;
    }
  }
}

}  // namespace
}  // namespace pleinair::hal::synthetic
