#include <chrono>
#include <variant>

#include <benchmark/benchmark.h>

#include "hal/cameras/synthetic/synthetic_camera.h"
#include "hal/cameras/synthetic/world/world.h"

namespace pleinair::hal {
namespace {

/// One frame of a shot, the sensor's noise included, on one core.
void filmFrame(benchmark::State& state) {
  SteppedClock clock;
  SyntheticOptions options{
      .size = {static_cast<int>(state.range(0)), static_cast<int>(state.range(1))},
      .shot = static_cast<SyntheticShot>(state.range(2))};
  if (state.range(3) != 0) options.rowTime = options.framePeriod / options.size.height;
  SyntheticCamera camera(options, clock);
  if (!camera.start({})) state.SkipWithError("does not start");
  for ([[maybe_unused]] auto _ : state) {
    const NextFrame next = camera.next(kNoDeadline);
    if (!std::holds_alternative<CapturedFrame>(next)) state.SkipWithError("no frame");
  }
  state.SetLabel(std::string(toString(options.shot)));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(filmFrame)
    ->ArgNames({"width", "height", "shot", "rolling"})
    ->ArgsProduct({{640}, {480}, {0, 1, 2, 3, 4, 5, 6, 7, 8}, {0}})
    ->Args({640, 480, 0, 1})
    ->Args({1280, 720, 0, 0})
    ->Unit(benchmark::kMillisecond);

/// The work of the first start(): painting and lighting, on all cores.
void paintTheWorkbench(benchmark::State& state) {
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(
        synthetic::paintWorkbench({.texelMetres = static_cast<double>(state.range(0)) / 1e5}));
  }
}
BENCHMARK(paintTheWorkbench)
    ->ArgName("texelsOf10um")
    ->Arg(75)
    ->Arg(60)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

/// The whole flow between two frames.
void flowOfAFrame(benchmark::State& state) {
  SteppedClock clock;
  const SyntheticCamera camera({}, clock);
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(camera.flowField(0, 5));
}
BENCHMARK(flowOfAFrame)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pleinair::hal
