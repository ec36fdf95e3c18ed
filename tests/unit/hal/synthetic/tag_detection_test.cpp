#include <chrono>
#include <map>
#include <memory>

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
#include <glm/geometric.hpp>

#include "tests/unit/hal/synthetic/captured.h"

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

TEST(SyntheticTags, AreFoundWhereTheTruthSays) {
  constexpr int kFrames = 12;
  SyntheticOptions options{.framePeriod = std::chrono::milliseconds(1370)};
  const std::vector<Image> frames = capturedFrames(options, kFrames);
  SteppedClock clock;
  const SyntheticCamera camera(options, clock);
  Detector detector;
  double sum = 0;
  double worst = 0;
  int corners = 0;
  std::map<int, int> timesFound;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::map<int, Corners> found = detector.detect(frames[i]);
    for (const TagTruth& truth : camera.truth(i).tags) {
      const auto detected = found.find(truth.tag.id);
      EXPECT_TRUE(!truth.isInside || detected != found.end())
          << "tag " << truth.tag.id << " in frame " << i;
      if (detected == found.end() || !truth.isInside) continue;
      ++timesFound[truth.tag.id];
      for (std::size_t corner = 0; corner < 4; ++corner, ++corners) {
        const double error = glm::distance(detected->second[corner], truth.cornersPx[corner]);
        EXPECT_LT(error, 0.6) << "tag " << truth.tag.id << " corner " << corner << " frame " << i;
        sum += error;
        worst = std::max(worst, error);
      }
    }
    EXPECT_LE(found.size(), 5u);
  }
  EXPECT_EQ(timesFound.size(), 5u) << "every tag comes into view";
  EXPECT_LT(sum / corners, 0.3);
  RecordProperty("meanCornerErrorPx", std::to_string(sum / corners));
  RecordProperty("worstCornerErrorPx", std::to_string(worst));
}

TEST(SyntheticTags, LieFaceUpInRightHandedFrames) {
  const std::vector<DeskTag> tags = deskTags();
  ASSERT_EQ(tags.size(), 5u);
  for (std::size_t i = 0; i < tags.size(); ++i) {
    EXPECT_EQ(tags[i].id, static_cast<int>(i));
    EXPECT_EQ(tags[i].family, "tag36h11");
    const glm::dmat4& pose = tags[i].worldFromTag;
    EXPECT_NEAR(glm::determinant(glm::dmat3(pose)), 1, 1e-12);
    EXPECT_EQ(glm::dvec3(pose[2]), glm::dvec3(0, 0, -1)) << "z goes into the desk";
    EXPECT_EQ(pose[3].z, 0);
  }
}

}  // namespace
}  // namespace pleinair::hal::synthetic
