#include <chrono>
#include <vector>

#include <benchmark/benchmark.h>

#include "pipeline/tracking/luma.h"
#include "pipeline/tracking/picture_motion.h"
#include "pipeline/tracking/tracker.h"
#include "tests/support/tag_scene.h"

namespace pleinair::tracking {
namespace {

using support::poseOf;

CameraModel cameraOf(hal::FrameSize size) {
  const double focal = 0.82 * size.width;
  return {{.fx = focal, .fy = focal, .cx = size.width / 2.0, .cy = size.height / 2.0},
          {.k1 = -0.1, .k2 = 0.03},
          size};
}

/// Five tags on a table, from askew.
std::vector<support::SceneTag> table() {
  return {{.id = 0, .edgeMetres = 0.12, .worldFromTag = poseOf({}, {})},
          {.id = 1, .edgeMetres = 0.08, .worldFromTag = poseOf({0, 0, 0.3}, {0.2, 0.02, 0.0})},
          {.id = 2, .edgeMetres = 0.08, .worldFromTag = poseOf({0, 0, -0.5}, {-0.2, 0.03, 0.0})},
          {.id = 7, .edgeMetres = 0.05, .worldFromTag = poseOf({0, 0, 2.0}, {0.05, 0.15, 0.0})},
          {.id = 23, .edgeMetres = 0.05, .worldFromTag = poseOf({0, 0, 0.7}, {-0.06, -0.15, 0.0})}};
}

/// track() with noise of 2 grey levels, which is what makes thresholding work.
void trackFiveTags(benchmark::State& state) {
  const hal::FrameSize size{static_cast<int>(state.range(0)), static_cast<int>(state.range(1))};
  const CameraModel camera = cameraOf(size);
  const auto tags = table();
  const hal::Image image = support::renderTags(camera, poseOf({0.35, 0.1, 0.2}, {0.0, 0.0, 0.7}),
                                               tags, {.noiseSigma = 2.0});
  std::vector<TagMarker> markers;
  for (const support::SceneTag& tag : tags) {
    markers.push_back(
        {.id = tag.id, .edgeMetres = tag.edgeMetres, .worldFromTag = tag.worldFromTag});
  }
  Tracker tracker(camera, markers);
  hal::TimePoint now{};
  for (auto _ : state) {
    now += std::chrono::milliseconds(33);
    const TrackingResult result = tracker.track(image.view(), now);
    if (result.tags.size() != tags.size() || !result.cameraFromWorld) {
      state.SkipWithError("a tag was not found");
      break;
    }
  }
}
BENCHMARK(trackFiveTags)
    ->ArgNames({"width", "height"})
    ->Args({640, 480})
    ->Args({1280, 720})
    ->Unit(benchmark::kMillisecond);

/// The poses alone: five tags' candidates and the world.
void solveFiveTags(benchmark::State& state) {
  const CameraModel camera = cameraOf({1280, 720});
  const glm::dmat4 cameraFromWorld = poseOf({0.35, 0.1, 0.2}, {0.0, 0.0, 0.7});
  const auto tags = table();
  WorldPoseSolver solver;
  for (auto _ : state) {
    std::vector<WorldTag> seen;
    for (const support::SceneTag& tag : tags) {
      WorldTag world{.worldFromTag = tag.worldFromTag, .edgeMetres = tag.edgeMetres};
      world.corners =
          support::trueCorners(camera, cameraFromWorld * tag.worldFromTag, tag.edgeMetres);
      world.candidates = tagPoseCandidates(camera, world.corners, tag.edgeMetres);
      seen.push_back(std::move(world));
    }
    benchmark::DoNotOptimize(solver.solve(camera, seen, std::nullopt));
  }
}
BENCHMARK(solveFiveTags)->Unit(benchmark::kMicrosecond);

/// The picture's motion as a whole: two pictures by turns, so that every frame moves by a few px.
void followThePicture(benchmark::State& state) {
  const hal::FrameSize size{static_cast<int>(state.range(0)), static_cast<int>(state.range(1))};
  const CameraModel camera = cameraOf(size);
  LumaConverter luma;
  std::vector<hal::Image> images;
  for (const double aside : {0.0, 0.004}) {
    images.push_back(support::renderTags(camera, poseOf({0.35, 0.1, 0.2}, {aside, 0.0, 0.7}),
                                         table(), {.noiseSigma = 2.0}));
  }
  PictureMotion motion;
  std::size_t number = 0;
  for (auto _ : state) {
    const hal::Image& image = images[number++ % 2];
    benchmark::DoNotOptimize(motion.follow(luma.convert(image.view()), size));
  }
}
BENCHMARK(followThePicture)
    ->ArgNames({"width", "height"})
    ->Args({640, 480})
    ->Args({1280, 720})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pleinair::tracking
