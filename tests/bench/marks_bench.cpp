// Cost of anchors and the motion field on the GPU, pass by pass and together, with the image motion
// given (tracking_bench measures its cost); and of all of it, image motion included, on the
// workbench. Time is wall time up to a fence, CPU that of all threads; on a shared machine compare
// ratios within a run.
#include <chrono>
#include <cstdint>
#include <random>
#include <vector>

#include <benchmark/benchmark.h>

#include "hal/error.h"
#include "pipeline/gpu/context/egl_context.h"
#include "pipeline/gpu/gpu_shaders.h"
#include "pipeline/gpu/handle.h"
#include "pipeline/marks/anchors/anchor_set.h"
#include "pipeline/marks/marks_shaders.h"
#include "pipeline/scene/render/ar_frame_renderer.h"
#include "pipeline/scene/scene_shaders.h"
#include "pipeline/tracking/motion/image_motion_estimator.h"
#include "tests/bench/benchmarks.h"
#include "tests/reports/tracking/pose_measures.h"
#include "tests/reports/tracking/truth_sequence.h"
#include "tests/support/many_parts.h"
#include "tests/support/random_vectors.h"

namespace {

using namespace pleinair;         // NOLINT(google-build-using-namespace): a program, not a header
using namespace pleinair::bench;  // NOLINT(google-build-using-namespace)

constexpr std::size_t kFeatures = 200;
constexpr int kNodePixels = 8;
constexpr int kFieldPixels = 16;

constexpr marks::DensityRule kOneACell{.target = 1, .birthBelow = 1, .deathAbove = 3};

/// A picture that moves by a slow pan, told by all sources.
struct Motion {
  explicit Motion(hal::FrameSize size) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> part(0.0F, 1.0F);
    for (std::uint32_t i = 0; i < kFeatures; ++i) {
      const glm::vec2 at =
          glm::vec2(support::randomVec2(part, random)) * glm::vec2(size.width, size.height);
      features.push_back({.id = i, .previous = at, .current = at + kPan, .errorPx = 0.1F});
    }
    image.features = features;
    image.frameSize = size;
    image.picture = {.currentFromPrevious = {1, 0, 0, 0, 1, 0, kPan.x, kPan.y, 1}, .errorPx = 0.02};
    image.flow.nodes = {size.width / kNodePixels, size.height / kNodePixels};
    image.flow.stepPx = glm::vec2(kNodePixels);
    flow.assign(static_cast<std::size_t>(image.flow.nodes.pixels()), {kPan, 0.3F, 0.0F});
    image.flow.forward = flow;
    image.flow.backward = flow;
    image.still.fields = {size.width / kFieldPixels, size.height / kFieldPixels};
    still.assign(static_cast<std::size_t>(image.still.fields.pixels()),
                 tracking::StaticRegions::kNotStatic);
    image.still.errorPx = still;
  }
  static constexpr glm::vec2 kPan{-0.7F, 0.3F};
  std::vector<tracking::FeatureMotion> features;
  std::vector<glm::vec4> flow;
  std::vector<float> still;
  tracking::ImageMotion image;
};

struct Bench {
  Bench(hal::FrameSize size, gpu::PassTiming timing, marks::DensityRule rule)
      : timer(timing, &context.info()), motion(size) {
    library.add(gpu::gpuShaders());
    library.add(gpu::sceneShaders());
    library.add(gpu::marksShaders());
    field = std::make_unique<marks::MotionField>(library, size);
    anchors =
        std::make_unique<marks::AnchorSet>(library, size, marks::AnchorOptions{.density = rule});
    colour = gpu::Texture(gpu::TextureFormat::kRgba8, size);
    ids = gpu::Texture(gpu::TextureFormat::kR32ui, size);
    for (int i = 0; i < 8; ++i) advance();
    hal::orThrow(gpu::Fence::insert().wait());
    library.setTimer(&timer);
  }

  void advance() {
    motion.image.sinceSequence = number;
    advance(motion.image);
  }
  void advance(const tracking::ImageMotion& image) {
    ++number;
    scene::ArFrame frame{.colour = &colour,
                         .ids = &ids,
                         .measuredMotion = scene::MeasuredMotion{.motion = &image},
                         .sequence = number,
                         .captureTime = timeOfFrame(number)};
    field->update(frame);
    anchors->advance(frame, *field);
  }

  gpu::EglContext context;
  gpu::ShaderLibrary library;
  gpu::PassTimer timer;
  Motion motion;
  std::unique_ptr<marks::MotionField> field;
  std::unique_ptr<marks::AnchorSet> anchors;
  gpu::Texture colour;
  gpu::Texture ids;
  std::uint64_t number = 0;
};

void together(benchmark::State& state, marks::DensityRule rule) {
  Bench bench(sizeOf(state), gpu::PassTiming::kOff, rule);
  for ([[maybe_unused]] auto _ : state) {
    bench.advance();
    hal::orThrow(gpu::Fence::insert().wait());
  }
  double alive = 0.0;
  for (const marks::Anchor& each : bench.anchors->read()) alive += each.isAlive() ? 1.0 : 0.0;
  state.counters["anchors"] = alive;
}

void passes(benchmark::State& state, std::initializer_list<std::string_view> names) {
  Bench bench(sizeOf(state), gpu::PassTiming::kFences, {});
  timePasses(state, bench.timer, names, [&bench] { bench.advance(); });
}

/// The walk around the workbench, forth and back: the motion found in the picture, then anchors.
void withThePicturesMotion(benchmark::State& state) {
  using Clock = std::chrono::steady_clock;
  const hal::FrameSize size = sizeOf(state);
  const tracking::TruthSequence walk = tracking::filmWorkbench({.frameCount = 30, .size = size});
  Bench bench(size, gpu::PassTiming::kOff, kOneACell);
  tracking::ImageMotionEstimator estimator;
  std::vector<double> all;
  std::vector<double> finding;
  const auto last = static_cast<std::uint64_t>(walk.frames.size() - 1);
  for ([[maybe_unused]] auto _ : state) {
    const std::uint64_t at = bench.number % (2 * last);
    const hal::ImageView frame = walk.frames[at <= last ? at : 2 * last - at].luma.view();
    const Clock::time_point start = Clock::now();
    const tracking::ImageMotion& motion =
        estimator.follow(frame.planes[0], size, bench.number + 1);  // as advance() counts
    const Clock::time_point found = Clock::now();
    bench.advance(motion);
    hal::orThrow(gpu::Fence::insert().wait());
    finding.push_back(std::chrono::duration<double, std::milli>(found - start).count());
    all.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
  }
  state.counters["median_ms"] = tracking::percentile(all, 0.5);
  state.counters["p95_ms"] = tracking::percentile(all, 0.95);
  state.counters["finding_ms"] = tracking::percentile(finding, 0.5);
  double alive = 0.0;
  for (const marks::Anchor& each : bench.anchors->read()) alive += each.isAlive() ? 1.0 : 0.0;
  state.counters["anchors"] = alive;
}

/// 60,000 anchors at 640×480.
constexpr marks::DensityRule kThirteenACell{.target = 13, .birthBelow = 11, .deathAbove = 15};

/// A wall of 500 boxes that fills the image, and anchors on it: where the time of a frame goes. The
/// frame's time is without the timer, which waits before and after each pass.
void onParts(benchmark::State& state, support::Parts parts, bool isReal) {
  using Clock = std::chrono::steady_clock;
  const hal::FrameSize size = sizeOf(state);
  const scene::Scene scene = support::wallOfBoxes(25, 20, parts, isReal);
  Bench bench(size, gpu::PassTiming::kFences, kThirteenACell);
  scene::ArFrameRenderer renderer(bench.library, scene);
  const tracking::CameraModel camera = scene::assumedCamera(size);
  int at = 0;
  std::vector<double> composing;
  std::vector<double> carrying;
  const auto frame = [&] {
    bench.motion.image.sinceSequence = bench.number++;
    const Clock::time_point start = Clock::now();
    scene::ArFrame made = renderer.compose(
        bench.colour, camera, {.cameraFromWorld = support::wallBefore(0.32, at++)}, bench.number,
        timeOfFrame(bench.number), {.surfaces = true, .measuredMotion = true});
    hal::orThrow(gpu::Fence::insert().wait());
    const Clock::time_point composed = Clock::now();
    made.measuredMotion = scene::MeasuredMotion{.motion = &bench.motion.image};
    bench.field->update(made);
    bench.anchors->advance(made, *bench.field);
    hal::orThrow(gpu::Fence::insert().wait());
    composing.push_back(std::chrono::duration<double, std::milli>(composed - start).count());
    carrying.push_back(std::chrono::duration<double, std::milli>(Clock::now() - composed).count());
  };
  bench.library.setTimer(nullptr);
  for (int i = 0; i < 5; ++i) frame();
  composing.clear();
  carrying.clear();
  for ([[maybe_unused]] auto _ : state) frame();
  state.counters["compose_ms"] = tracking::percentile(composing, 0.5);
  state.counters["anchors_ms"] = tracking::percentile(carrying, 0.5);
  bench.library.setTimer(&bench.timer);
  constexpr int kTimed = 10;
  for (int i = 0; i < kTimed; ++i) frame();
  int passes = 0;
  for (const gpu::PassTime& each : bench.timer.times()) {
    if (!each.pass.starts_with("anchors: anchor")) continue;
    passes += each.count;
    const std::string name = each.pass.substr(std::string_view("anchors: anchor_").size());
    state.counters[name + "_ms"] = 1e-6 * static_cast<double>(each.total.count()) / kTimed;
  }
  state.counters["passes"] = static_cast<double>(passes) / kTimed;
  double alive = 0.0;
  double onSurface = 0.0;
  for (const marks::Anchor& each : bench.anchors->read()) {
    alive += each.isAlive() ? 1.0 : 0.0;
    onSurface += each.isOnSurface() ? 1.0 : 0.0;
  }
  state.counters["anchors"] = alive;
  state.counters["on_parts"] = onSurface;
}

void atTheSmallSize(benchmark::internal::Benchmark* benchmark) {
  benchmark->Args({640, 480})->Unit(benchmark::kMillisecond)->UseRealTime();
  benchmark->MeasureProcessCPUTime()->Iterations(60);
}

BENCHMARK_CAPTURE(onParts, onePart, support::Parts::kJoined, false)
    ->Name("marks/60,000 anchors on one part")
    ->Apply(atTheSmallSize);
BENCHMARK_CAPTURE(onParts, manyParts, support::Parts::kApart, false)
    ->Name("marks/60,000 anchors on 500 parts")
    ->Apply(atTheSmallSize);
BENCHMARK_CAPTURE(onParts, oneRealPart, support::Parts::kJoined, true)
    ->Name("marks/60,000 anchors on one real part")
    ->Apply(atTheSmallSize);
BENCHMARK_CAPTURE(onParts, manyRealParts, support::Parts::kApart, true)
    ->Name("marks/60,000 anchors on 500 real parts")
    ->Apply(atTheSmallSize);

BENCHMARK_CAPTURE(together, onePerCell, kOneACell)
    ->Name("marks/one anchor a cell")
    ->Apply(atBothSizes);
BENCHMARK_CAPTURE(together, twoPerCell, {})->Name("marks/two anchors a cell")->Apply(atBothSizes);
BENCHMARK(withThePicturesMotion)
    ->Name("marks/one anchor a cell, with finding the picture's motion")
    ->Iterations(240)
    ->Apply(atBothSizes);
void motionField(benchmark::State& state) {
  passes(state, {"marks: feature_layers", "marks: motion_field"});
}

void carryAnchors(benchmark::State& state) {
  passes(state, {"anchors: anchor_image", "anchors: anchor_surface"});
}

void keepDensity(benchmark::State& state) {
  passes(state, {"anchors: anchor_count", "anchors: anchor_density", "anchors: anchor_plan",
                 "anchors: anchor_spawn"});
}

BENCHMARK(motionField)->Name("marks/motion field")->Apply(passAtBothSizes);
BENCHMARK(carryAnchors)->Name("marks/carry anchors")->Apply(passAtBothSizes);
BENCHMARK(keepDensity)->Name("marks/keep density")->Apply(passAtBothSizes);

}  // namespace
