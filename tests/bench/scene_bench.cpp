// What composing an AR frame costs, wall time with the GPU waited for.
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

#include <benchmark/benchmark.h>
#include <glm/ext/matrix_transform.hpp>

#include "hal/error.h"
#include "pipeline/gpu/egl_context.h"
#include "pipeline/scene/ar_frame_renderer.h"
#include "pipeline/scene/scene_file.h"
#include "pipeline/scene/scene_shaders.h"

namespace pleinair::scene {
namespace {

constexpr const char* kGear = R"(
[[tag]]
id = 0
edge_m = 0.12
[[model]]
source = "builtin:gear"
attach = "tag:0"
)";

constexpr const char* kGearbox = R"(
[[tag]]
id = 0
edge_m = 0.12
[[model]]
source = "builtin:gearbox"
attach = "tag:0"
scale = 0.5
)";

/// The engine of the shared test data: 110,336 triangles in 67 parts.
constexpr const char* kEngine = R"(
[[tag]]
id = 0
edge_m = 0.12
[[model]]
source = "2CylinderEngine.glb"
attach = "tag:0"
scale = 0.00018
)";

/// A gear that fills about half of the picture's height, seen aslant; or nothing, with `text`
/// empty.
void compose(benchmark::State& state, const std::string& text) {
  const hal::FrameSize size{static_cast<int>(state.range(0)), static_cast<int>(state.range(1))};
  const gpu::EglContext context;
  gpu::ShaderLibrary library;
  library.add(gpu::gpuShaders());
  library.add(gpu::sceneShaders());
  const std::filesystem::path models = std::filesystem::path(PLEINAIR_SHARED_DATA) / "models";
  if (text == kEngine && !std::filesystem::exists(models)) {
    state.SkipWithError("no real test data");
    return;
  }
  ArFrameRenderer renderer(library, parseScene(text, "bench", models));
  renderer.warmUp(size);
  gpu::Texture picture(gpu::TextureFormat::kRgba8, size, gpu::TextureFilter::kLinear);
  const gpu::RenderTarget pictureTarget({&picture});
  pictureTarget.beginDiscarding();
  pictureTarget.clearColour(0, {0.3F, 0.4F, 0.5F, 1.0F});
  const TagSighting sighting{
      .cameraFromTag =
          glm::rotate(glm::translate(glm::dmat4(1.0), {0.0, 0.0, 0.25}), 0.5, {1.0, 0.0, 0.0})};
  const tracking::CameraModel camera = assumedCamera(size);
  gpu::PassTimer timer;
  std::uint64_t sequence = 0;
  for (auto _ : state) {
    const hal::TimePoint time(++sequence * std::chrono::milliseconds(33));  // what turns, turns
    renderer.compose(picture, camera, {.tags = {&sighting, 1}}, sequence, time, timer);
    hal::orThrow(gpu::Fence::insert().wait());
  }
}

BENCHMARK_CAPTURE(compose, gear, kGear)
    ->Args({640, 480})
    ->Args({1280, 720})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(compose, gearbox, kGearbox)
    ->Args({640, 480})
    ->Args({1280, 720})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(compose, engine, kEngine)
    ->Args({640, 480})
    ->Args({1280, 720})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(compose, cameraOnly, "")
    ->Args({640, 480})
    ->Args({1280, 720})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime();

}  // namespace
}  // namespace pleinair::scene
