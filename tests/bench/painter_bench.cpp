// The whole chain from decoded frames to planes in memory: tags, poses, the gearbox, watercolor,
// paper and read-back, on the workbench's walkaround; beside the same with the style "none", and
// pass by pass.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <benchmark/benchmark.h>

#include "firmware_app/scene/workbench_scene.h"
#include "hal/cameras/synthetic/synthetic_camera.h"
#include "pipeline/engine/painter.h"
#include "pipeline/scene/description/scene_file.h"
#include "tests/bench/benchmarks.h"
#include "tests/bench/workbench_film.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace pleinair;  // NOLINT(google-build-using-namespace): a program, not a header

constexpr std::uint64_t kFrames = 24;

/// A recorded sequence in memory.
struct Recording {
  explicit Recording(hal::FrameSize size) {
    frames = bench::workbenchFilm(size, kFrames);
    hal::SteppedClock clock;
    const hal::SyntheticCamera camera({.size = size, .frameCount = kFrames}, clock);
    const support::TemporaryFolder folder;
    const auto path = folder.path() / "bench.toml";
    hal::orThrow(app::writeWorkbenchScene(path, camera.truth(0), size));
    scene = scene::loadScene(path);
  }
  std::vector<hal::CapturedFrame> frames;
  scene::Scene scene;
};

double medianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

hal::FrameSize sizeOf(const benchmark::State& state) {
  return {static_cast<int>(state.range(0)), static_cast<int>(state.range(1))};
}

class Chain {
 public:
  Chain(hal::FrameSize size, const char* style, std::size_t quality, gpu::PassTiming timing)
      : recording_(size),
        painter_({.pictureSize = size,
                  .scene = recording_.scene,
                  .style = style,
                  .passTiming = timing,
                  .qualityLevels = quality > 0}),
        parameters_(painter_.defaultParameters()),
        reader_(painter_.openReadback({hal::PixelFormat::kI420, size})) {
    parameters_.quality = quality;
    for (int i = 0; i < 4; ++i) paint();
  }
  /// Whether tags were found.
  bool paint() {
    hal::CapturedFrame frame = recording_.frames[bench::forthAndBack(number_, kFrames)];
    frame.sequence = number_;
    frame.captureTime =
        hal::TimePoint(hal::Duration(33'333'333) * static_cast<std::int64_t>(number_));
    ++number_;
    const hal::Result<Picture> painted = painter_.paint(frame, parameters_);
    hal::orThrow(painter_.hasRoom(reader_) ? painter_.poll(reader_, picture_)
                                           : painter_.wait(reader_, picture_));
    return painted && !painted->tracking.tags.empty();
  }
  Painter& painter() { return painter_; }

 private:
  Recording recording_;
  Painter painter_;
  PaintParameters parameters_;
  int reader_;
  OutputFrame picture_;
  std::uint64_t number_ = 0;
};

void wholeChain(benchmark::State& state, const char* style, std::size_t quality = 0) {
  using Clock = std::chrono::steady_clock;
  Chain chain(sizeOf(state), style, quality, gpu::PassTiming::kOff);
  std::vector<double> ms;
  for ([[maybe_unused]] auto _ : state) {
    const Clock::time_point start = Clock::now();
    if (!chain.paint()) state.SkipWithError("no tag was found");
    ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
  }
  state.counters["frames/s"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
  state.counters["median_ms"] = medianOf(std::move(ms));
}

/// Each pass by itself, GPU waited for before and after: medians, ms.
void stages(benchmark::State& state, std::size_t quality) {
  Chain chain(sizeOf(state), "watercolor", quality, gpu::PassTiming::kFences);
  bench::timeEachPass(
      state, [&] { return chain.painter().passTimes(); }, [&] { chain.paint(); });
}

double processSeconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// The cost of sampled pass times: blocks of frames with and without them alternate, so that other
/// load on the machine slows both. CPU time of all threads; the mean ratio of the pairs of blocks,
/// and the upper bound of its 95 % confidence interval (Student's t).
void sampledPassTimes(benchmark::State& state) {
  constexpr int kPairs = 16;
  constexpr double kStudent95 = 1.753;  // one-sided, 15 degrees of freedom
  const auto framesOfBlock = static_cast<int>(gpu::PassTimer::kSampledEvery);
  Chain without(sizeOf(state), "watercolor", 0, gpu::PassTiming::kOff);
  Chain sampled(sizeOf(state), "watercolor", 0, gpu::PassTiming::kSampled);
  const auto secondsOf = [&](Chain& chain) {
    const double start = processSeconds();
    for (int i = 0; i < framesOfBlock; ++i) chain.paint();
    return processSeconds() - start;
  };
  for ([[maybe_unused]] auto _ : state) {
    double sum = 0.0;
    double squares = 0.0;
    for (int i = 0; i < kPairs; ++i) {
      const bool isSampledFirst = i % 2 == 1;
      const double first = secondsOf(isSampledFirst ? sampled : without);
      const double second = secondsOf(isSampledFirst ? without : sampled);
      const double ratio = isSampledFirst ? first / second : second / first;
      sum += ratio;
      squares += ratio * ratio;
    }
    const double mean = sum / kPairs;
    const double variance = std::max(0.0, (squares - sum * mean) / (kPairs - 1));
    state.counters["cpu_ratio"] = mean;
    state.counters["cpu_ratio_upper95"] = mean + kStudent95 * std::sqrt(variance / kPairs);
    state.counters["frames_each"] = kPairs * framesOfBlock;
  }
}

void atBothSizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->Args({640, 480})->Args({1280, 720})->Unit(benchmark::kMillisecond)->UseRealTime();
  benchmark->MeasureProcessCPUTime()->MinTime(2.0);
}

BENCHMARK_CAPTURE(wholeChain, watercolor, "watercolor")
    ->Name("chain/watercolor")
    ->Apply(atBothSizes);
BENCHMARK_CAPTURE(wholeChain, none, "none")->Name("chain/none")->Apply(atBothSizes);

BENCHMARK(sampledPassTimes)
    ->Name("chain/watercolor, cost of sampled pass times")
    ->Args({320, 240})
    ->Iterations(1)
    ->Unit(benchmark::kSecond);

BENCHMARK_CAPTURE(stages, full, std::size_t{0})
    ->Name("chain/watercolor, pass by pass")
    ->Apply(atBothSizes);

/// Each level below the full one, under its name.
void levels(benchmark::State& state, std::size_t quality) {
  wholeChain(state, "watercolor", quality);
}

const bool kLevelsAreRegistered = [] {
  const std::vector<QualityLevel> all = qualityLevels();
  for (std::size_t i = 1; i < all.size(); ++i) {
    benchmark::RegisterBenchmark(("chain/watercolor/" + all[i].name).c_str(), levels, i)
        ->Args({640, 480})
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime()
        ->MeasureProcessCPUTime()
        ->MinTime(2.0);
  }
  benchmark::RegisterBenchmark(
      ("chain/watercolor/" + all.back().name + ", pass by pass").c_str(),
      [last = all.size() - 1](benchmark::State& state) { stages(state, last); })
      ->Args({640, 480})
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime()
      ->MinTime(2.0);
  return true;
}();

}  // namespace
