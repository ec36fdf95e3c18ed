// Cost of composing an AR frame: wall time until the GPU is done.
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include <benchmark/benchmark.h>
#include <glm/ext/matrix_transform.hpp>

#include "hal/error.h"
#include "pipeline/gpu/context/egl_context.h"
#include "pipeline/gpu/gpu_shaders.h"
#include "pipeline/scene/description/scene_file.h"
#include "pipeline/scene/light/light_estimator.h"
#include "pipeline/scene/render/ar_frame_renderer.h"
#include "pipeline/scene/scene_shaders.h"
#include "tests/bench/benchmarks.h"
#include "tests/support/tag_scene.h"

namespace pleinair::scene {
namespace {

using bench::atBothSizes;

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

constexpr const char* kGearboxNoShadow = R"(
[light]
shadow = 0
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

/// A rippled ball of 75,000 triangles about the origin, half of it bent to and fro by a joint: what
/// a model costs that is posed anew, vertex by vertex, for each frame.
Model bendingBall() {
  constexpr int kRings = 151;
  constexpr int kSides = 250;
  Mesh mesh;
  for (int ring = 0; ring <= kRings; ++ring) {
    const double polar = std::numbers::pi * (ring + 0.5) / (kRings + 1);
    for (int side = 0; side < kSides; ++side) {
      const double angle = 2.0 * std::numbers::pi * side / kSides;
      const glm::vec3 unit(std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle),
                           std::cos(polar));
      const double radius = 0.05 * (1.0 + 0.05 * std::sin(12.0 * angle) * std::sin(10.0 * polar));
      mesh.vertices.push_back({.position = static_cast<float>(radius) * unit, .normal = unit});
      const float upper = glm::smoothstep(-0.3F, 0.3F, unit.z);
      mesh.joints.push_back({.joints = {0, 1, 0, 0}, .weights = {1.0F - upper, upper, 0.0F, 0.0F}});
      if (ring == kRings) continue;
      const auto at = [&](int r, int s) {
        return static_cast<std::uint32_t>(r * kSides + s % kSides);
      };
      mesh.triangles.push_back({at(ring, side), at(ring + 1, side), at(ring + 1, side + 1)});
      mesh.triangles.push_back({at(ring, side), at(ring + 1, side + 1), at(ring, side + 1)});
    }
  }
  Model model;
  model.surfaces.push_back({.mesh = std::move(mesh)});
  model.materials.emplace_back();
  model.rig.nodes = {{}, {.parent = 0}};
  model.rig.skins.push_back({.joints = {0, 1}, .jointFromMesh = {2, glm::dmat4(1.0)}});
  Channel bend{.node = 1, .property = AnimatedProperty::kRotation, .width = 4};
  bend.seconds = {0.0F, 1.0F, 2.0F};
  bend.values = {0.0F, 0.0F, 0.0F, 1.0F, 0.2F, 0.1F, 0.0F, 0.97F, 0.0F, 0.0F, 0.0F, 1.0F};
  model.rig.clips.push_back({.name = "bend", .seconds = 2.0, .channels = {std::move(bend)}});
  model.parts.push_back({.name = "ball", .surfaceCount = 1, .node = 0, .skin = 0});
  numberParts(model);
  return model;
}

constexpr const char* kBendingBall = "bending ball";
constexpr const char* kBendingBallNoShadow = "bending ball without a shadow";

Scene sceneOf(const std::string& text, const std::filesystem::path& models) {
  if (text != kBendingBall && text != kBendingBallNoShadow)
    return parseScene(text, "bench", models);
  Scene scene = parseScene(kGear, "bench", models);
  scene.models[0].model = std::make_shared<const Model>(bendingBall());
  scene.models[0].playback.clip = 0;
  if (text == kBendingBallNoShadow) scene.light.shadow = 0.0F;
  return scene;
}

/// A model that fills about half of the picture's height, seen aslant; or nothing, with `text`
/// empty.
void compose(benchmark::State& state, const std::string& text, ArFrameNeeds needs = {}) {
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
  ArFrameRenderer renderer(library, sceneOf(text, models));
  renderer.warmUp(size);
  gpu::Texture picture(gpu::TextureFormat::kRgba8, size, gpu::TextureFilter::kLinear);
  const gpu::RenderTarget pictureTarget({&picture});
  pictureTarget.beginDiscarding();
  pictureTarget.clearColour(0, {0.3F, 0.4F, 0.5F, 1.0F});
  const TagSighting sighting{
      .cameraFromTag =
          glm::rotate(glm::translate(glm::dmat4(1.0), {0.0, 0.0, 0.25}), 0.5, {1.0, 0.0, 0.0})};
  const tracking::CameraModel camera = assumedCamera(size);
  std::uint64_t sequence = 0;
  for ([[maybe_unused]] auto _ : state) {
    const hal::TimePoint time(++sequence * std::chrono::milliseconds(33));  // what turns, turns
    renderer.compose(picture, camera, {.tags = {&sighting, 1}}, sequence, time, needs);
    hal::orThrow(gpu::Fence::insert().wait());
  }
}

BENCHMARK_CAPTURE(compose, gear, kGear)->Apply(atBothSizes);
BENCHMARK_CAPTURE(compose, gearbox, kGearbox)->Apply(atBothSizes);
BENCHMARK_CAPTURE(compose, gearboxNoShadow, kGearboxNoShadow)->Apply(atBothSizes);
BENCHMARK_CAPTURE(compose, engine, kEngine)->Apply(atBothSizes);
BENCHMARK_CAPTURE(compose, gearboxAllBuffers, kGearbox, {.surfaces = true})->Apply(atBothSizes);
BENCHMARK_CAPTURE(compose, bendingBall, kBendingBall)->Apply(atBothSizes);
BENCHMARK_CAPTURE(compose, bendingBallAllBuffers, kBendingBall, {.surfaces = true})
    ->Apply(atBothSizes);
BENCHMARK_CAPTURE(compose, bendingBallAllBuffersNoShadow, kBendingBallNoShadow, {.surfaces = true})
    ->Apply(atBothSizes);
BENCHMARK_CAPTURE(compose, cameraOnly, "")->Apply(atBothSizes);

/// The light on three places, from five tags in an RGB picture.
void estimateLight(benchmark::State& state) {
  const hal::FrameSize size{static_cast<int>(state.range(0)), static_cast<int>(state.range(1))};
  const tracking::CameraModel camera = assumedCamera(size);
  const glm::dmat4 view = support::poseOf({0.4, 0.1, 0.0}, {0.0, 0.0, 0.7});
  std::vector<support::SceneTag> tags;
  std::vector<tracking::TagMarker> markers;
  for (int i = 0; i < 5; ++i) {
    tags.push_back({.id = i,
                    .edgeMetres = 0.08,
                    .worldFromTag = support::poseOf({0.2 * i - 0.4, 0.0, 0.0},
                                                    {0.14 * i - 0.28, 0.05 * (i % 2), 0.0})});
    markers.push_back({.id = i, .edgeMetres = 0.08, .worldFromTag = tags.back().worldFromTag});
  }
  const hal::Image image =
      support::neutralPicture(support::renderTags(camera, view, tags), hal::PixelFormat::kRgb8);
  tracking::Tracker tracker(camera, markers);
  const tracking::TrackingResult tracked = tracker.track(image.view(), {});
  const std::array<std::optional<int>, 3> places{0, 3, std::nullopt};
  LightEstimator estimator(markers, tracking::kDefaultTagFamily, places);
  hal::TimePoint time;
  for ([[maybe_unused]] auto _ : state) {
    estimator.follow(image.view(), tracked, time += std::chrono::milliseconds(33));
  }
  state.counters["tags"] = static_cast<double>(tracked.tags.size());
}
BENCHMARK(estimateLight)->Args({640, 480})->Args({1280, 720})->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace pleinair::scene
