// The overlay's share of a frame: whole frames of the workbench's walkaround, from decoded pictures
// to planes in memory, with a step of the shipped procedure over the gearbox and without, in turn.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <benchmark/benchmark.h>

#include "firmware_app/overlay/procedure_film.h"
#include "firmware_app/scene/workbench_scene.h"
#include "hal/cameras/synthetic/synthetic_camera.h"
#include "pipeline/engine/painter.h"
#include "pipeline/scene/description/scene_file.h"
#include "tests/bench/benchmarks.h"
#include "tests/bench/workbench_film.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace pleinair;         // NOLINT(google-build-using-namespace): a program, not a header
using namespace pleinair::bench;  // NOLINT(google-build-using-namespace)

constexpr std::uint64_t kFrames = 16;
constexpr double kStudent95 = 1.753;  // one-sided, 15 degrees of freedom
constexpr int kPairs = 16;

/// A recording in memory, whose scene has the procedure's machine; and a step of the procedure.
struct Station {
  Station(hal::FrameSize size, const std::string& step) {
    frames = bench::workbenchFilm(size, kFrames);
    hal::SteppedClock clock;
    const hal::SyntheticCamera camera({.size = size, .frameCount = kFrames}, clock);
    const support::TemporaryFolder folder;
    const auto path = folder.path() / "bench.toml";
    hal::orThrow(app::writeWorkbenchScene(path, camera.truth(0), size));
    scene = scene::loadScene(path);
    film.emplace(
        app::ProcedureFilmOptions{
            .folder = std::filesystem::path(PLEINAIR_TESTS_DIR).parent_path() /
                      "config/procedures/gearbox",
            .step = step},
        scene);
    content = film->at(hal::Duration{0}, size);
  }
  std::vector<hal::CapturedFrame> frames;
  scene::Scene scene;
  std::optional<app::ProcedureFilm> film;
  std::shared_ptr<const overlay::OverlayContent> content;
};

class Chain {
 public:
  Chain(const Station& station, hal::FrameSize size, const std::string& style, bool hasOverlay)
      : station_(station),
        painter_({.pictureSize = size,
                  .scene = station.scene,
                  .style = style,
                  .overlay = hasOverlay,
                  .machine = station.film->machine()}),
        parameters_(painter_.defaultParameters()),
        reader_(painter_.openReadback({hal::PixelFormat::kI420, size})) {
    if (hasOverlay) parameters_.overlay = station.content;
    for (int i = 0; i < 4; ++i) paint();
  }

  void paint() {
    hal::CapturedFrame frame = station_.frames[forthAndBack(number_, kFrames)];
    frame.sequence = number_;
    frame.captureTime = timeOfFrame(number_);
    ++number_;
    const Picture painted = hal::orThrow(painter_.paint(frame, parameters_));
    hal::orThrow(painter_.hasRoom(reader_) ? painter_.poll(reader_, picture_)
                                           : painter_.wait(reader_, picture_));
    isShown_ = painted.overlay && painted.overlay->trust.opacity > 0.99F;
  }
  bool isShown() const { return isShown_; }

 private:
  const Station& station_;
  Painter painter_;
  PaintParameters parameters_;
  int reader_;
  OutputFrame picture_;
  std::uint64_t number_ = 0;
  bool isShown_ = false;
};

double processSeconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Processor time of all threads with the overlay, of that without: blocks alternate, so that other
/// load on the machine slows both. The mean ratio of the pairs, and the upper bound of its 95 %
/// confidence interval (Student's t).
void shareOfOverlay(benchmark::State& state, const char* style, const char* step) {
  constexpr int kFramesOfBlock = 6;
  const Station station(sizeOf(state), step);
  Chain without(station, sizeOf(state), style, false);
  Chain with(station, sizeOf(state), style, true);
  int shown = 0;
  const auto secondsOf = [&](Chain& chain) {
    const double start = processSeconds();
    for (int i = 0; i < kFramesOfBlock; ++i) {
      chain.paint();
      shown += chain.isShown() ? 1 : 0;
    }
    return processSeconds() - start;
  };
  for ([[maybe_unused]] auto _ : state) {
    double sum = 0.0;
    double squares = 0.0;
    double seconds = 0.0;
    for (int i = 0; i < kPairs; ++i) {
      const bool isOverlayFirst = i % 2 == 1;
      const double first = secondsOf(isOverlayFirst ? with : without);
      const double second = secondsOf(isOverlayFirst ? without : with);
      const double ratio = isOverlayFirst ? first / second : second / first;
      sum += ratio;
      squares += ratio * ratio;
      seconds += isOverlayFirst ? second : first;
    }
    const double mean = sum / kPairs;
    const double variance = std::max(0.0, (squares - sum * mean) / (kPairs - 1));
    state.counters["cpu_ratio"] = mean;
    state.counters["cpu_ratio_upper95"] = mean + kStudent95 * std::sqrt(variance / kPairs);
    state.counters["cpu_ms_without"] = 1e3 * seconds / (kPairs * kFramesOfBlock);
    state.counters["shown_percent"] = 100.0 * shown / (kPairs * kFramesOfBlock);
  }
}

void once(benchmark::internal::Benchmark* benchmark) {
  benchmark->Args({640, 480})->Iterations(1)->Unit(benchmark::kSecond);
}

BENCHMARK_CAPTURE(shareOfOverlay, drain, "watercolor", "drain")
    ->Name("overlay's share/watercolor, one small part")
    ->Apply(once);
BENCHMARK_CAPTURE(shareOfOverlay, housing, "watercolor", "overhaul")
    ->Name("overlay's share/watercolor, the largest part")
    ->Apply(once);
BENCHMARK_CAPTURE(shareOfOverlay, painterly, "painterly", "overhaul")
    ->Name("overlay's share/painterly, the largest part")
    ->Apply(once);

}  // namespace
