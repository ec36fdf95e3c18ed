#include <cmath>
#include <optional>

#include <glm/geometric.hpp>

#include "hal/cameras/synthetic/world/world.h"
#include "tests/unit/hal/synthetic/captured.h"
#include "tests/unit/hal/synthetic/ray_oracle.h"

namespace pleinair::hal::synthetic {
namespace {

/// A camera, and the oracle's exposures of the same frames.
struct Both {
  explicit Both(SyntheticShot shot)
      : options{.shot = shot}, camera(options, clock), motion(shot, options.seed) {}
  SteppedClock clock;
  SyntheticOptions options;
  SyntheticCamera camera;
  Motion motion;

  CameraView view(std::uint64_t frame) const {
    return {syntheticIntrinsics(options.size), camera.truth(frame).cameraFromWorld};
  }
  BodyPoses bodies(std::uint64_t frame) const {
    return motion.bodies(static_cast<double>(frame) * 0.033333333);
  }
};

/// The oracle's flow: find the surface point, move it, project it, and test whether it is visible
/// there.
FlowVector oracleFlow(const Both& both, std::uint64_t from, std::uint64_t to, glm::dvec2 pixel) {
  const Geometry& geometry = workbenchGeometry();
  const auto hit = oracleHit(geometry, both.view(from), both.bodies(from), pixel);
  if (!hit) return {};
  glm::dvec3 later = hit->world;
  if (hit->body != kRoom) {
    later = glm::dvec3(both.bodies(to)[hit->body] * glm::inverse(both.bodies(from)[hit->body]) *
                       glm::dvec4(later, 1));
  }
  const CameraView second = both.view(to);
  const glm::dvec3 seen(second.cameraFromWorld * glm::dvec4(later, 1));
  if (seen.z <= 0) return {};
  const glm::dvec2 px(second.intrinsics.fx * seen.x / seen.z + second.intrinsics.cx,
                      second.intrinsics.fy * seen.y / seen.z + second.intrinsics.cy);
  const auto again = oracleHit(geometry, second, both.bodies(to), px);
  const bool isInside = px.x >= 0 && px.y >= 0 && px.x < 640 && px.y < 480;
  return {px - pixel, isInside && again && glm::distance(again->world, later) < 1e-6};
}

void expectFlowOfOracle(SyntheticShot shot, std::uint64_t from, std::uint64_t to, int least,
                        int most) {
  const Both both(shot);
  int visible = 0;
  for (int i = 0; i < 150; ++i) {
    const glm::dvec2 pixel(13 + (i * 251) % 620, 7 + (i * 113) % 470);
    const FlowVector flow = both.camera.flow(from, to, pixel);
    const FlowVector expected = oracleFlow(both, from, to, pixel);
    EXPECT_LT(glm::distance(flow.px, expected.px), 1e-6) << pixel.x << " " << pixel.y;
    EXPECT_EQ(flow.visible, expected.visible) << pixel.x << " " << pixel.y;
    visible += flow.visible ? 1 : 0;
  }
  EXPECT_GE(visible, least);
  EXPECT_LE(visible, most);
}

TEST(SyntheticFlow, IsTheOracles) {
  expectFlowOfOracle(SyntheticShot::kWalkaround, 3, 33, 90, 149);
  expectFlowOfOracle(SyntheticShot::kDolly, 0, 40, 60, 149);
  expectFlowOfOracle(SyntheticShot::kStill, 0, 40, 150, 150);
}

TEST(SyntheticFlow, FollowsWhatMovesAndWhatItHides) {
  expectFlowOfOracle(SyntheticShot::kOccluder, 20, 60, 60, 145);
  expectFlowOfOracle(SyntheticShot::kOccluder, 62, 66, 100, 150);
  const Both both(SyntheticShot::kOccluder);
  // The glove moves while the bench beside it is static.
  int moving = 0;
  for (int i = 0; i < 150; ++i) {
    const glm::dvec2 pixel(13 + (i * 251) % 620, 7 + (i * 113) % 470);
    const auto hit = oracleHit(workbenchGeometry(), both.view(62), both.bodies(62), pixel);
    if (!hit || hit->body != kArm) continue;
    ++moving;
    EXPECT_GT(glm::length(both.camera.flow(62, 66, pixel).px), 2.0);
  }
  EXPECT_GT(moving, 4);
}

TEST(SyntheticFlow, FollowsASlowHandAndWhatItUncovers) {
  expectFlowOfOracle(SyntheticShot::kHand, 70, 84, 100, 150);
  expectFlowOfOracle(SyntheticShot::kHand, 190, 230, 100, 150);
}

TEST(SyntheticFlow, FollowsThePartsOfPersons) {
  expectFlowOfOracle(SyntheticShot::kVisitors, 95, 99, 120, 150);
  expectFlowOfOracle(SyntheticShot::kVisitors, 300, 340, 120, 150);
  expectFlowOfOracle(SyntheticShot::kCrossing, 92, 98, 120, 149);
}

TEST(SyntheticFlow, IsTheOraclesAcrossACut) {
  expectFlowOfOracle(SyntheticShot::kCut, 59, 61, 5, 120);
}

TEST(SyntheticFlow, TakesEachVisibleTagCornerToWhereItIsLater) {
  SteppedClock clock;
  const SyntheticCamera camera({}, clock);
  int corners = 0;
  for (std::uint64_t from = 0; from < 200; from += 40) {
    const GroundTruth before = camera.truth(from);
    const GroundTruth after = camera.truth(from + 17);
    for (std::size_t tag = 0; tag < before.tags.size(); ++tag) {
      if (!before.tags[tag].isVisible) continue;
      for (std::size_t corner = 0; corner < 4; ++corner, ++corners) {
        const glm::dvec2 start = before.tags[tag].cornersPx[corner];
        const FlowVector flow = camera.flow(from, from + 17, start);
        EXPECT_LT(glm::distance(start + flow.px, after.tags[tag].cornersPx[corner]), 1e-3);
      }
    }
  }
  EXPECT_GT(corners, 40);
}

/// Mean absolute difference, in levels, between `first` and `second` warped along the flow.
double warpedDifference(const Image& first, const Image& second, const FlowField& flow) {
  double sum = 0;
  int count = 0;
  const FrameSize size = flow.size;
  const ImageView a = first.view();
  const ImageView b = second.view();
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const auto i = static_cast<std::size_t>(y * size.width + x);
      const float toX = static_cast<float>(x) + flow.px[i].x;
      const float toY = static_cast<float>(y) + flow.px[i].y;
      const auto column = static_cast<int>(std::floor(toX));
      const auto row = static_cast<int>(std::floor(toY));
      const bool hasNeighbours =
          column >= 0 && row >= 0 && column + 1 < size.width && row + 1 < size.height;
      if (flow.visible[i] == 0 || !hasNeighbours) continue;
      const auto at = [&b](int dx, int dy) {
        return static_cast<double>(b.row(0, dy)[3 * static_cast<std::size_t>(dx) + 1]);
      };
      const double tx = toX - static_cast<float>(column);
      const double ty = toY - static_cast<float>(row);
      const double there = (at(column, row) * (1 - tx) + at(column + 1, row) * tx) * (1 - ty) +
                           (at(column, row + 1) * (1 - tx) + at(column + 1, row + 1) * tx) * ty;
      sum += std::abs(there - a.row(0, y)[3 * static_cast<std::size_t>(x) + 1]);
      ++count;
    }
  }
  return sum / count;
}

void expectPicturesFollowTheFlow(SyntheticShot shot, std::uint64_t from, std::uint64_t to,
                                 Duration rowTime) {
  SyntheticOptions options{.size = {320, 240}, .shot = shot, .noiseSigma = 0, .rowTime = rowTime};
  const std::vector<Image> frames = capturedFrames(options, static_cast<int>(to) + 1);
  SteppedClock clock;
  const SyntheticCamera camera(options, clock);
  const FlowField flow = camera.flowField(from, to);
  FlowField none = flow;
  for (glm::vec2& px : none.px) px = glm::vec2(0);
  const double along = warpedDifference(frames[from], frames[to], flow);
  const double standing = warpedDifference(frames[from], frames[to], none);
  EXPECT_LT(along, 2.5);
  EXPECT_GT(standing, 3 * along) << "the camera must move enough to tell";
  const FlowVector one = camera.flow(from, to, {100.5, 60.5});
  EXPECT_LT(glm::distance(glm::vec2(one.px), flow.px[60 * 320 + 100]), 1e-4F);
}

TEST(SyntheticFlow, IsHowThePictureMoves) {
  expectPicturesFollowTheFlow(SyntheticShot::kWalkaround, 0, 9, Duration::zero());
}

TEST(SyntheticFlow, IsHowPersonsMove) {
  SyntheticOptions options{.size = {320, 240}, .shot = SyntheticShot::kVisitors, .noiseSigma = 0};
  const std::vector<Image> frames = capturedFrames(options, 100);
  SteppedClock clock;
  const SyntheticCamera camera(options, clock);
  const MovingMask mask = camera.movingMask(96);
  FlowField flow = camera.flowField(96, 99);
  for (std::size_t i = 0; i < flow.visible.size(); ++i) {
    if (mask.bytes[i] == 0) flow.visible[i] = 0;
  }
  FlowField none = flow;
  for (glm::vec2& px : none.px) px = glm::vec2(0);
  const double along = warpedDifference(frames[96], frames[99], flow);
  EXPECT_LT(along, 3.5);
  EXPECT_GT(warpedDifference(frames[96], frames[99], none), 3 * along);
}

TEST(SyntheticFlow, IsHowThePictureMovesUnderARollingShutter) {
  expectPicturesFollowTheFlow(SyntheticShot::kPan, 0, 6, Duration(33'333'333) / 240);
}

}  // namespace
}  // namespace pleinair::hal::synthetic
