// The whole chain from decoded frames to planes in memory: tags, poses, the gearbox, watercolor,
// paper and read-back, on the workbench's walkaround; beside the same with the style "none".
#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

#include <benchmark/benchmark.h>

#include "firmware_app/workbench_scene.h"
#include "hal/cameras/synthetic/synthetic_camera.h"
#include "pipeline/painter.h"
#include "pipeline/scene/scene_file.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace pleinair;  // NOLINT(google-build-using-namespace): a program, not a header

constexpr std::uint64_t kFrames = 24;

/// What the camera saw, in memory.
struct Recording {
  explicit Recording(hal::FrameSize size) {
    hal::SteppedClock clock;
    hal::SyntheticCamera camera({.size = size, .frameCount = kFrames}, clock);
    hal::orThrow(camera.start({}));
    for (std::uint64_t i = 0; i < kFrames; ++i) {
      hal::NextFrame next = camera.next(hal::TimePoint::max());
      frames.push_back(std::get<hal::CapturedFrame>(std::move(next)));
    }
    camera.stop();
    const support::TemporaryFolder folder;
    const auto path = folder.path() / "bench.toml";
    hal::orThrow(app::writeWorkbenchScene(path, camera.truth(0), size));
    scene = scene::loadScene(path);
  }
  std::vector<hal::CapturedFrame> frames;
  scene::Scene scene;
};

/// Forth and back, so that no frame is far from the one before.
std::size_t frameAt(std::uint64_t number) {
  const std::uint64_t place = number % (2 * kFrames - 2);
  return place < kFrames ? place : 2 * kFrames - 2 - place;
}

void wholeChain(benchmark::State& state, const char* style, std::size_t quality = 0) {
  const hal::FrameSize size{static_cast<int>(state.range(0)), static_cast<int>(state.range(1))};
  const Recording recording(size);
  Painter painter({.pictureSize = size,
                   .scene = recording.scene,
                   .style = style,
                   .qualityLevels = quality > 0});
  PaintParameters parameters = painter.defaultParameters();
  parameters.quality = quality;
  const int reader = painter.openReader({hal::PixelFormat::kI420, size});
  ReadPicture picture;
  std::uint64_t number = 0;
  const auto paint = [&] {
    hal::CapturedFrame frame = recording.frames[frameAt(number)];
    frame.sequence = number;
    frame.captureTime =
        hal::TimePoint(hal::Duration(33'333'333) * static_cast<std::int64_t>(number));
    ++number;
    const hal::Result<Picture> painted = painter.paint(frame, parameters);
    if (!painted || painted->tracking.tags.empty()) state.SkipWithError("no tag was found");
    hal::orThrow(painter.take(reader, picture, !painter.hasRoom(reader)));
  };
  for (int i = 0; i < 4; ++i) paint();
  for ([[maybe_unused]] auto _ : state) paint();
  state.counters["frames/s"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void atBothSizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->Args({640, 480})->Args({1280, 720})->Unit(benchmark::kMillisecond)->UseRealTime();
  benchmark->MeasureProcessCPUTime()->MinTime(2.0);
}

BENCHMARK_CAPTURE(wholeChain, watercolor, "watercolor")
    ->Name("chain/watercolor")
    ->Apply(atBothSizes);
BENCHMARK_CAPTURE(wholeChain, none, "none")->Name("chain/none")->Apply(atBothSizes);

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
  return true;
}();

}  // namespace
