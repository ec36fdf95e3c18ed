// Cost of the painterly style and of hatching, in the thesis's four stages (table 1: tensor field,
// features and matching, warping of anchors, painting), beside OpenCV's stylization of the same
// frames in the same run. Stages are timed by fences, which makes their sum more than the whole.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <benchmark/benchmark.h>
#include <opencv2/imgproc.hpp>
#include <opencv2/photo.hpp>

#include "firmware_app/scene/workbench_scene.h"
#include "hal/cameras/synthetic/synthetic_camera.h"
#include "pipeline/engine/painter.h"
#include "pipeline/scene/description/scene_file.h"
#include "tests/bench/workbench_film.h"

namespace {

using namespace pleinair;  // NOLINT(google-build-using-namespace): a program, not a header

constexpr std::uint64_t kFrames = 16;

hal::SyntheticOptions workbenchOf(hal::FrameSize size) {
  return {.size = size, .frameCount = kFrames};
}

/// What is on the bench. `kTags`: only what models would be attached to.
enum class Shown { kNothing, kTags, kModels, kLargeModel };

/// As wide as half of the picture.
constexpr const char* kLargeModel = R"(
[[model]]
source = "builtin:gearbox"
attach = "tag:0"
length_m = 0.5
)";

scene::Scene sceneOf(hal::FrameSize size, Shown shown) {
  if (shown == Shown::kNothing) return {};
  hal::SteppedClock clock;
  const hal::GroundTruth truth = hal::SyntheticCamera(workbenchOf(size), clock).truth(0);
  std::string text = shown == Shown::kModels ? app::workbenchScene(truth, size)
                                             : app::workbenchSetting(truth, size);
  if (shown == Shown::kLargeModel) text += kLargeModel;
  return scene::parseScene(text, "bench", {});
}

struct Bench {
  Bench(hal::FrameSize size, const char* style, gpu::PassTiming timing,
        Shown shown = Shown::kNothing)
      : Bench(bench::workbenchFilm(size, kFrames), size, style, timing, shown) {}
  Bench(std::vector<hal::CapturedFrame> film, hal::FrameSize size, const char* style,
        gpu::PassTiming timing, Shown shown)
      : frames(std::move(film)),
        painter({.pictureSize = size,
                 .scene = sceneOf(size, shown),
                 .style = style,
                 .tracksTags = shown != Shown::kNothing,
                 .passTiming = timing}),
        parameters(painter.defaultParameters()) {
    for (int i = 0; i < 8; ++i) paint();
  }
  void paint() {
    hal::CapturedFrame frame = frames[bench::forthAndBack(number, kFrames)];
    frame.sequence = number;
    frame.captureTime =
        hal::TimePoint(hal::Duration(33'333'333) * static_cast<std::int64_t>(number));
    ++number;
    hal::orThrow(painter.paint(frame, parameters));
  }
  std::vector<hal::CapturedFrame> frames;
  Painter painter;
  PaintParameters parameters;
  std::uint64_t number = 0;
};

hal::FrameSize sizeOf(const benchmark::State& state) {
  return {static_cast<int>(state.range(0)), static_cast<int>(state.range(1))};
}

void whole(benchmark::State& state, const char* style, Shown shown = Shown::kNothing) {
  Bench bench(sizeOf(state), style, gpu::PassTiming::kOff, shown);
  for ([[maybe_unused]] auto _ : state) {
    bench.paint();
    hal::orThrow(bench.painter.snapshot());  // waits; reading it back counts, too
  }
}

/// Whether a pass is one of those, by the begin of its name.
bool beginsWithOneOf(std::string_view pass, std::initializer_list<std::string_view> names) {
  return std::ranges::any_of(names, [&](std::string_view name) { return pass.starts_with(name); });
}

std::string_view stageOf(std::string_view pass) {
  if (beginsWithOneOf(pass, {"tensors: gradient", "tensors: edge_", "tensors: tensor_"}))
    return "tensor";
  if (pass == "follow picture") return "features";
  if (beginsWithOneOf(pass, {"marks: feature_layers", "marks: motion_field", "anchors: anchor_"}))
    return "warping";
  return "painting";
}

/// As whole(), with a parameter of the style other than it is by itself.
void with(benchmark::State& state, const char* name, const char* value) {
  Bench bench(sizeOf(state), "painterly", gpu::PassTiming::kOff);
  bench.parameters.style = bench.parameters.style.with(name, value);
  bench.paint();
  for ([[maybe_unused]] auto _ : state) {
    bench.paint();
    hal::orThrow(bench.painter.snapshot());
  }
}

/// The first frame after a parameter was changed: forth and back between two values.
void change(benchmark::State& state, const char* name, const char* one, const char* other) {
  Bench bench(sizeOf(state), "painterly", gpu::PassTiming::kOff);
  const config::ParameterValues& style = bench.parameters.style;
  const std::array<config::ParameterValues, 2> values{style.with(name, one),
                                                      style.with(name, other)};
  for ([[maybe_unused]] auto _ : state) {
    bench.parameters.style = values.at(bench.number % 2);
    bench.paint();
    hal::orThrow(bench.painter.snapshot());
  }
}

/// From nothing to a painter whose first frame will find all made: the driver's shader cache on
/// disk decides about most of it.
void start(benchmark::State& state) {
  for ([[maybe_unused]] auto _ : state) {
    const Painter painter(
        {.pictureSize = sizeOf(state), .scene = {}, .style = "painterly", .tracksTags = false});
  }
}

void stages(benchmark::State& state, const char* style, Shown shown = Shown::kNothing) {
  Bench bench(sizeOf(state), style, gpu::PassTiming::kFences, shown);
  std::map<std::string, double, std::less<>> before;
  for (const gpu::PassTime& each : bench.painter.passTimes()) {
    before[each.pass] = std::chrono::duration<double, std::milli>(each.total).count();
  }
  for ([[maybe_unused]] auto _ : state) bench.paint();
  const auto frames = static_cast<double>(state.iterations());
  for (const gpu::PassTime& each : bench.painter.passTimes()) {
    const double total = std::chrono::duration<double, std::milli>(each.total).count();
    const double ms = (total - before[each.pass]) / frames;
    state.counters[each.pass + " ms"] = ms;
    state.counters["= " + std::string(stageOf(each.pass)) + " ms"] += ms;
  }
}

/// The cost of telling movers apart, by its passes, in a shot from a frame on.
void layers(benchmark::State& state, hal::SyntheticShot shot, std::uint64_t first) {
  Bench bench(bench::workbenchFilm(sizeOf(state), kFrames, shot, first), sizeOf(state), "painterly",
              gpu::PassTiming::kFences, Shown::kNothing);
  std::map<std::string, double, std::less<>> before;
  const auto passes = [&](auto each) {
    for (const gpu::PassTime& pass : bench.painter.passTimes()) {
      if (!beginsWithOneOf(pass.pass, {"movers: motion_layers", "movers: mover_"})) continue;
      each(pass.pass, std::chrono::duration<double, std::milli>(pass.total).count());
    }
  };
  passes([&](const std::string& pass, double ms) { before[pass] = ms; });
  for ([[maybe_unused]] auto _ : state) bench.paint();
  passes([&](const std::string& pass, double total) {
    const double ms = (total - before[pass]) / static_cast<double>(state.iterations());
    state.counters[pass + " ms"] = ms;
    state.counters["= layers ms"] += ms;
  });
}

void stylization(benchmark::State& state) {
  std::vector<cv::Mat> frames;
  for (const hal::CapturedFrame& each : bench::workbenchFilm(sizeOf(state), kFrames)) {
    cv::Mat bgr;
    const hal::FrameSize size = each.image.format.size;
    auto* const luma = const_cast<std::uint8_t*>(each.image.map().view().row(0, 0).data());
    cv::cvtColor(cv::Mat(size.height, size.width, CV_8UC1, luma,
                         each.image.map().view().planes[0].strideBytes),
                 bgr, cv::COLOR_GRAY2BGR);
    frames.push_back(bgr);
  }
  cv::Mat painted;
  std::uint64_t number = 0;
  for ([[maybe_unused]] auto _ : state)
    cv::stylization(frames[bench::forthAndBack(number++, kFrames)], painted);
}

void atSizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->Args({640, 480})->Args({1024, 768})->Args({1440, 1050});
  benchmark->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime()->MinTime(2.0);
}

BENCHMARK_CAPTURE(whole, painterly, "painterly")->Name("painterly/whole")->Apply(atSizes);
void atOneSize(benchmark::internal::Benchmark* benchmark) {
  benchmark->Args({640, 480});
  benchmark->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime()->MinTime(2.0);
}

BENCHMARK_CAPTURE(whole, tags, "painterly", Shown::kTags)
    ->Name("painterly/tags tracked")
    ->Apply(atOneSize);
BENCHMARK_CAPTURE(whole, models, "painterly", Shown::kModels)
    ->Name("painterly/with models")
    ->Apply(atOneSize);
BENCHMARK_CAPTURE(whole, large, "painterly", Shown::kLargeModel)
    ->Name("painterly/with a large model")
    ->Apply(atOneSize);
BENCHMARK_CAPTURE(stages, large, "painterly", Shown::kLargeModel)
    ->Name("painterly/stages/with a large model")
    ->Apply(atOneSize);
BENCHMARK_CAPTURE(stages, tags, "painterly", Shown::kTags)
    ->Name("painterly/stages/tags tracked")
    ->Apply(atOneSize);
BENCHMARK_CAPTURE(stages, models, "painterly", Shown::kModels)
    ->Name("painterly/stages/with models")
    ->Apply(atOneSize);
BENCHMARK_CAPTURE(whole, hatching, "hatching")->Name("hatching/whole")->Apply(atOneSize);
BENCHMARK_CAPTURE(stages, hatching, "hatching")->Name("hatching/stages")->Apply(atOneSize);
BENCHMARK_CAPTURE(with, quads, "quads", "thesis")->Name("painterly/4 (n + 2)")->Apply(atSizes);
BENCHMARK_CAPTURE(with, walk, "walk", "ahead")->Name("painterly/one way")->Apply(atOneSize);
BENCHMARK_CAPTURE(with, segments, "segments", "true")
    ->Name("painterly/with segments")
    ->Apply(atOneSize);
BENCHMARK_CAPTURE(with, bump, "bump", "each")->Name("painterly/bump each")->Apply(atSizes);
BENCHMARK_CAPTURE(change, brush, "brush", "dry", "round")
    ->Name("painterly/another brush")
    ->Apply(atOneSize);
BENCHMARK_CAPTURE(change, plan, "stroke_size", "4", "5")
    ->Name("painterly/another plan")
    ->Apply(atOneSize);
BENCHMARK(start)->Name("painterly/start")->Apply(atOneSize);
BENCHMARK_CAPTURE(stages, painterly, "painterly")->Name("painterly/stages")->Apply(atSizes);
BENCHMARK_CAPTURE(layers, still, hal::SyntheticShot::kStill, 0)
    ->Name("painterly/layers/still")
    ->Apply(atOneSize);
BENCHMARK_CAPTURE(layers, visitors, hal::SyntheticShot::kVisitors, 90)
    ->Name("painterly/layers/visitors")
    ->Apply(atOneSize);
BENCHMARK_CAPTURE(layers, walkaround, hal::SyntheticShot::kWalkaround, 0)
    ->Name("painterly/layers/walkaround")
    ->Apply(atOneSize);
BENCHMARK(stylization)->Name("OpenCV/stylization")->Apply(atSizes);

}  // namespace
