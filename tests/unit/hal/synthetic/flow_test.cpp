#include <cmath>
#include <optional>

#include <glm/geometric.hpp>

#include "hal/cameras/synthetic/desk_world.h"
#include "tests/unit/hal/synthetic/captured.h"

namespace pleinair::hal::synthetic {
namespace {

/// Looks straight down from `eye`, the world's y up in the picture; 90° wide.
CameraView lookingDown(glm::dvec3 eye) {
  CameraView view{{.fx = 320, .fy = 320, .cx = 320, .cy = 240}, glm::dmat4(1)};
  view.cameraFromWorld[1] = {0, -1, 0, 0};
  view.cameraFromWorld[2] = {0, 0, -1, 0};
  view.cameraFromWorld[3] = {-eye.x, eye.y, eye.z, 1};
  return view;
}
constexpr FrameSize kSize{640, 480};

TEST(SyntheticFlow, TakesEachTagCornerToWhereItIsLater) {
  SteppedClock clock;
  const SyntheticCamera camera({}, clock);
  for (std::uint64_t from = 0; from < 200; from += 40) {
    const GroundTruth before = camera.truth(from);
    const GroundTruth after = camera.truth(from + 17);
    for (std::size_t tag = 0; tag < before.tags.size(); ++tag) {
      for (std::size_t corner = 0; corner < 4; ++corner) {
        const glm::dvec2 start = before.tags[tag].cornersPx[corner];
        const glm::dvec2 end = after.tags[tag].cornersPx[corner];
        const FlowVector flow = camera.flow(from, from + 17, start);
        EXPECT_LT(glm::distance(start + flow.px, end), 1e-6);
        const bool isInside = end.x >= 0 && end.y >= 0 && end.x < 640 && end.y < 480;
        EXPECT_EQ(flow.visible, isInside);
      }
    }
  }
}

TEST(SyntheticFlow, MovesTheFloorLessThanTheDesk) {
  const CameraView first = lookingDown({0.7, 0, 0.8});
  const CameraView second = lookingDown({0.8, 0, 0.8});
  const glm::dvec2 desk = *first.project({0.6, 0, 0});
  const glm::dvec2 floor = *first.project({1.5, 0, kFloorZ});
  EXPECT_NEAR(flowBetween(first, second, kSize, desk).px.x, -320 * 0.1 / 0.8, 1e-9);
  EXPECT_NEAR(flowBetween(first, second, kSize, floor).px.x, -320 * 0.1 / (0.8 - kFloorZ), 1e-9);
}

TEST(SyntheticFlow, DoesNotSeeTheFloorThroughTheDesk) {
  const CameraView beside = lookingDown({1.2, 0, 0.8});
  const CameraView above = lookingDown({-0.3, 0, 0.8});
  const glm::dvec3 underTheEdge(1.0, 0, kFloorZ);
  const FlowVector flow = flowBetween(beside, above, kSize, *beside.project(underTheEdge));
  const glm::dvec2 later = *above.project(underTheEdge);
  ASSERT_LT(later.x, 640) << "inside the picture, so that only the desk can hide it";
  EXPECT_FALSE(flow.visible);
  EXPECT_TRUE(flowBetween(beside, beside, kSize, *beside.project(underTheEdge)).visible);
}

/// Mean absolute difference, in levels, of `first` to `second` looked up along the flow.
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

TEST(SyntheticFlow, IsHowThePictureMoves) {
  SyntheticOptions options{.size = {320, 240}, .noiseSigma = 0};
  const std::vector<Image> frames = capturedFrames(options, 8);
  SteppedClock clock;
  const SyntheticCamera camera(options, clock);
  const FlowField flow = camera.flowField(0, 7);
  FlowField none = flow;
  for (glm::vec2& px : none.px) px = glm::vec2(0);
  const double along = warpedDifference(frames[0], frames[7], flow);
  const double standing = warpedDifference(frames[0], frames[7], none);
  RecordProperty("meanDifferenceLevels", std::to_string(along));
  EXPECT_LT(along, 4.0);
  EXPECT_GT(standing, 3 * along) << "the camera must move enough to tell";
  const FlowVector one = camera.flow(0, 7, {100.5, 60.5});
  EXPECT_LT(glm::distance(glm::vec2(one.px), flow.px[60 * 320 + 100]), 1e-4F);
}

}  // namespace
}  // namespace pleinair::hal::synthetic
