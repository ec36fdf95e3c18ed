// The live pipeline in real time: how far from its due time each picture is handed over, with
// nothing else to do and with every core kept busy by somebody else.
#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include <benchmark/benchmark.h>

#include "firmware_app/live/live_painter.h"
#include "pipeline/runtime/live_pipeline.h"
#include "pipeline/runtime/live_threads.h"
#include "pipeline/styles/registry.h"
#include "tests/support/live_simulation.h"
#include "tests/support/pass_through_painter.h"

namespace pleinair {
namespace {

using namespace std::chrono_literals;

constexpr hal::Duration kPeriod = 33'333us;
constexpr hal::Duration kDuration = 10s;

/// Threads that do nothing but take time.
class BusyCores {
 public:
  explicit BusyCores(bool isOn) {
    for (unsigned i = 0; isOn && i < std::thread::hardware_concurrency(); ++i) {
      threads_.emplace_back([](const std::stop_token& stopped) {
        for (std::uint64_t n = 0; !stopped.stop_requested(); ++n) benchmark::DoNotOptimize(n);
      });
    }
  }

 private:
  std::vector<std::jthread> threads_;
};

struct Late {
  runtime::RuntimeStatus status;
  runtime::DurationHistogram presented;  ///< from capture until it was handed over
};

Late runLive(hal::FrameSize size, const std::string& style, hal::Duration latency) {
  hal::SteadyClock clock;
  auto selector = support::selectorOf(
      [size](hal::Clock& cameraClock) {
        return std::make_unique<support::PacedCamera>(
            support::PacedCameraOptions{.period = kPeriod, .size = size}, cameraClock);
      },
      clock);
  hal::CameraSupervisor supervisor(selector, clock);
  runtime::LivePipeline chain(supervisor, clock);
  runtime::LiveThreads threads(chain);
  while (!chain.capture().status().format) std::this_thread::sleep_for(1ms);
  std::vector<support::CapturingOutput::Note> notes;
  notes.reserve(10'000);
  auto output = std::make_unique<support::CapturingOutput>(notes, clock);
  const auto format = *output->start({.size = size, .framePeriod = {}});
  chain.addOutput(std::move(output), format, {.name = "paced", .waiting = 16});
  app::LiveControls controls(
      {.style = style, .painting = {.style = styles::styleKind(style).defaults, .view = {}}});
  chain.makePaintStage(
      [&]() -> std::unique_ptr<runtime::FramePainter> {
        if (style == "none") return std::make_unique<support::PassThroughPainter>();
        const PainterOptions options{.pictureSize = size, .style = style, .qualityLevels = true};
        return std::make_unique<app::LivePainter>(options, controls, controls.parameters());
      },
      {.governor = {.levels = qualityLevels().size(), .pinned = {}},
       .latency = {.configured = latency},
       .framePeriod = kPeriod});
  threads.startPainter();
  while (!threads.isPainterReady()) std::this_thread::sleep_for(1ms);
  threads.startOutputs();
  std::this_thread::sleep_for(kDuration);
  Late late{.status = chain.status(), .presented = chain.output(0).status().latency};
  threads.stop(10s);
  return late;
}

void live(benchmark::State& state, hal::FrameSize size, const std::string& style, bool isLoaded) {
  constexpr hal::Duration kLatency = 120ms;
  for ([[maybe_unused]] auto _ : state) {
    const BusyCores busy(isLoaded);
    const Late late = runLive(size, style, kLatency);
    state.counters["p50_ms"] = hal::toMilliseconds(late.presented.percentile(0.5));
    state.counters["p95_ms"] = hal::toMilliseconds(late.presented.percentile(0.95));
    state.counters["p99_ms"] = hal::toMilliseconds(late.presented.percentile(0.99));
    state.counters["max_ms"] = hal::toMilliseconds(late.presented.max());
    state.counters["shown"] = static_cast<double>(late.status.ledger.shown());
    state.counters["dropped"] = static_cast<double>(late.status.ledger.dropped());
    state.counters["level"] = static_cast<double>(late.status.painting.quality);
    state.counters["latency_ms"] = hal::toMilliseconds(late.status.painting.latency);
  }
}

#define PLEINAIR_LIVE(name, size, style)                                                  \
  BENCHMARK_CAPTURE(live, name##_idle, size, style, false)->Iterations(1)->UseRealTime(); \
  BENCHMARK_CAPTURE(live, name##_loaded, size, style, true)->Iterations(1)->UseRealTime()

PLEINAIR_LIVE(pass_through_640x480, (hal::FrameSize{640, 480}), "none");
PLEINAIR_LIVE(watercolor_320x240, (hal::FrameSize{320, 240}), "watercolor");
PLEINAIR_LIVE(watercolor_640x480, (hal::FrameSize{640, 480}), "watercolor");

}  // namespace
}  // namespace pleinair
