#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include <benchmark/benchmark.h>

#include "pipeline/tracking/image/luma.h"
#include "pipeline/tracking/motion/image_motion_estimator.h"
#include "pipeline/tracking/pose/tracker.h"
#include "tests/reports/tracking/pose_measures.h"
#include "tests/reports/tracking/truth_sequence.h"
#include "tests/support/tag_scene.h"
#include "tests/unit/tracking/desk_sequence.h"

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

std::vector<TagMarker> markersOf(std::span<const support::SceneTag> tags) {
  std::vector<TagMarker> markers;
  for (const support::SceneTag& tag : tags) {
    markers.push_back(
        {.id = tag.id, .edgeMetres = tag.edgeMetres, .worldFromTag = tag.worldFromTag});
  }
  return markers;
}

/// track() with noise of 2 grey levels, which is what makes thresholding work.
void trackFiveTags(benchmark::State& state) {
  const hal::FrameSize size{static_cast<int>(state.range(0)), static_cast<int>(state.range(1))};
  const CameraModel camera = cameraOf(size);
  const auto tags = table();
  const hal::Image image = support::renderTags(camera, poseOf({0.35, 0.1, 0.2}, {0.0, 0.0, 0.7}),
                                               tags, {.noiseSigma = 2.0});
  Tracker tracker(camera, markersOf(tags));
  hal::TimePoint now{};
  for ([[maybe_unused]] auto _ : state) {
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

/// The workbench on a walk around it, a second of it forth and back, so that nothing jumps.
const TruthSequence& walk(hal::FrameSize size) {
  static std::map<int, TruthSequence> made;
  const auto found = made.find(size.width);
  if (found != made.end()) return found->second;
  return made.emplace(size.width, filmWorkbench({.frameCount = 30, .size = size})).first->second;
}

const TruthSequence& desk() {
  static const TruthSequence made = readDesk();
  return made;
}

/// One iteration a frame, so that the median is a frame's: the whole picture is searched for tags
/// in some frames only.
void trackFrames(benchmark::State& state, const TruthSequence& sequence, bool detectorAlone) {
  Tracker tracker(sequence.camera, sequence.markers);
  TagDetector detector;
  DetectionCounters counters;
  std::vector<double> times;
  std::ptrdiff_t at = 0;
  std::ptrdiff_t step = 1;
  hal::TimePoint now{};
  const auto count = std::ssize(sequence.frames);
  for ([[maybe_unused]] auto _ : state) {
    const hal::ImageView frame = sequence.frames[static_cast<std::size_t>(at)].luma.view();
    const auto start = std::chrono::steady_clock::now();
    if (detectorAlone) {
      benchmark::DoNotOptimize(detector.detect(frame.planes[0], frame.format.size, counters));
    } else {
      benchmark::DoNotOptimize(tracker.track(frame, now));
    }
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    times.push_back(took.count());
    now += std::chrono::milliseconds(33);
    if (at + step < 0 || at + step >= count) step = -step;
    at += step;
  }
  state.counters["median_ms"] = percentile(times, 0.5);
  state.counters["p95_ms"] = percentile(times, 0.95);
}

void trackWorkbench(benchmark::State& state) {
  trackFrames(state, walk({static_cast<int>(state.range(0)), static_cast<int>(state.range(1))}),
              state.range(2) != 0);
}
BENCHMARK(trackWorkbench)
    ->ArgNames({"width", "height", "detectorAlone"})
    ->Args({640, 480, 0})
    ->Args({640, 480, 1})
    ->Args({1280, 720, 0})
    ->Args({1280, 720, 1})
    ->Iterations(240)
    ->Unit(benchmark::kMillisecond);

void trackDesk(benchmark::State& state) {
  if (!hasDeskSequence()) {
    state.SkipWithError("no sequence desk_6dof in " PLEINAIR_SHARED_DATA);
    return;
  }
  trackFrames(state, desk(), state.range(0) != 0);
}
BENCHMARK(trackDesk)
    ->ArgName("detectorAlone")
    ->Arg(0)
    ->Arg(1)
    ->Iterations(240)
    ->Unit(benchmark::kMillisecond);

/// The poses alone: five tags' candidates and the world.
void solveFiveTags(benchmark::State& state) {
  const CameraModel camera = cameraOf({1280, 720});
  const glm::dmat4 cameraFromWorld = poseOf({0.35, 0.1, 0.2}, {0.0, 0.0, 0.7});
  const auto tags = table();
  WorldPoseSolver solver;
  for ([[maybe_unused]] auto _ : state) {
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

/// All that is found out about how the picture moves, on the walk around the workbench.
void estimateMotion(benchmark::State& state, const ImageMotionOptions& options) {
  const hal::FrameSize size{static_cast<int>(state.range(0)), static_cast<int>(state.range(1))};
  const TruthSequence& sequence = walk(size);
  ImageMotionEstimator estimator(options);
  std::vector<double> times;
  std::ptrdiff_t at = 0;
  std::ptrdiff_t step = 1;
  std::uint64_t number = 0;  // of frames
  const auto count = std::ssize(sequence.frames);
  for ([[maybe_unused]] auto _ : state) {
    const hal::ImageView frame = sequence.frames[static_cast<std::size_t>(at)].luma.view();
    const auto start = std::chrono::steady_clock::now();
    benchmark::DoNotOptimize(estimator.follow(frame.planes[0], size, number++));
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    times.push_back(took.count());
    if (at + step < 0 || at + step >= count) step = -step;
    at += step;
  }
  state.counters["median_ms"] = percentile(times, 0.5);
  state.counters["p95_ms"] = percentile(times, 0.95);
}
/// CPU is that of all threads.
void motionSizes(benchmark::internal::Benchmark* row) {
  row->ArgNames({"width", "height"})
      ->Args({640, 480})
      ->Args({1280, 720})
      ->Iterations(240)
      ->MeasureProcessCPUTime()
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
}
BENCHMARK_CAPTURE(estimateMotion, reference_features,
                  ImageMotionOptions{.features = FeatureMethod::kHarrisSift,
                                     .flow = false,
                                     .staticRegions = false})
    ->Apply(motionSizes);
BENCHMARK_CAPTURE(estimateMotion, fast_features,
                  ImageMotionOptions{.flow = false, .staticRegions = false})
    ->Apply(motionSizes);
BENCHMARK_CAPTURE(estimateMotion, and_stillness, ImageMotionOptions{.flow = false})
    ->Apply(motionSizes);
BENCHMARK_CAPTURE(estimateMotion, and_flow, ImageMotionOptions{})->Apply(motionSizes);

}  // namespace
}  // namespace pleinair::tracking
