// Cost of watercolor, pass by pass and whole, beside OpenCV's stylization of the same frames
// in the same run. Time is wall time up to a fence, CPU that of all threads; on a shared machine
// compare ratios within a run.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <vector>

#include <benchmark/benchmark.h>
#include <opencv2/photo.hpp>

#include "hal/error.h"
#include "pipeline/gpu/context/egl_context.h"
#include "pipeline/gpu/gpu_shaders.h"
#include "pipeline/gpu/handle.h"
#include "pipeline/marks/marks_shaders.h"
#include "pipeline/scene/scene_shaders.h"
#include "pipeline/styles/registry.h"
#include "tests/bench/benchmarks.h"

namespace {

using namespace pleinair;         // NOLINT(google-build-using-namespace): a program, not a header
using namespace pleinair::bench;  // NOLINT(google-build-using-namespace)

constexpr int kFrames = 8;
constexpr double kPace = 2.0;  // px a frame, of a picture 480 px high

/// A moving scene with flat parts, texture, edges and sensor noise, RGBA8.
std::vector<std::uint8_t> framePixels(hal::FrameSize size, int number, double pace = kPace) {
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(size.pixels()) * 4, 255);
  std::mt19937 random(static_cast<unsigned>(number));
  const double scale = size.height / 480.0;
  std::size_t at = 0;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x, at += 4) {
      const double u = x / scale + number * pace;
      const double v = y / scale;
      const bool disc = std::hypot(std::fmod(u, 160.0) - 80.0, std::fmod(v, 160.0) - 80.0) < 45.0;
      const double wave = 30.0 * std::sin(u * 0.05) * std::sin(v * 0.07);
      const double texture = v > 300.0 ? 25.0 * std::sin(u * 0.9) * std::sin(v * 1.1) : 0.0;
      const double noise = static_cast<double>(random() % 9U) - 4.0;
      const double base = 130.0 + wave + texture + noise;
      pixels[at] = static_cast<std::uint8_t>(std::clamp(disc ? base + 80.0 : base, 0.0, 255.0));
      pixels[at + 1] = static_cast<std::uint8_t>(std::clamp(base - 20.0, 0.0, 255.0));
      pixels[at + 2] = static_cast<std::uint8_t>(std::clamp(disc ? 40.0 : base, 0.0, 255.0));
    }
  }
  return pixels;
}

/// A context, the style, and a few frames already on the GPU.
struct Bench {
  Bench(hal::FrameSize size, gpu::PassTiming timing, bool standing = false)
      : timer(timing, &context.info()), pace(standing ? 0.0 : kPace) {
    library.add(gpu::gpuShaders());
    library.add(gpu::sceneShaders());
    library.add(gpu::marksShaders());
    styles::addStyleShaders(library);
    style = styles::makeStyle("watercolor", library);
    for (int i = 0; i < kFrames; ++i) {
      frames.emplace_back(gpu::TextureFormat::kRgba8, size, gpu::TextureFilter::kLinear);
      frames.back().upload(framePixels(size, i, pace), static_cast<std::size_t>(size.width) * 4);
    }
    ids = gpu::Texture(gpu::TextureFormat::kR32ui, size);
    std::vector<std::uint32_t> idPixels(static_cast<std::size_t>(size.pixels()), 0);
    for (std::size_t i = idPixels.size() / 3; i < idPixels.size() / 2; ++i) {
      idPixels[i] = 1U << scene::kTriangleBits;
    }
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(idPixels.data());
    ids.upload({bytes, idPixels.size() * 4}, static_cast<std::size_t>(size.width) * 4);
    barycentrics = gpu::Texture(gpu::TextureFormat::kR32ui, size);
    std::ranges::fill(idPixels, 0U);
    barycentrics.upload({bytes, idPixels.size() * 4}, static_cast<std::size_t>(size.width) * 4);
    for (int i = 0; i < kFrames; ++i) paint();
    hal::orThrow(gpu::Fence::insert().wait());
    library.setTimer(&timer);
  }

  void paint() {
    // The film begins again after its last frame.
    const int step = number % kFrames == 0 && number > 0 ? 1 - kFrames : 1;
    const hal::FrameSize size = frames.front().size();
    motion.frameSize = size;
    motion.sinceSequence = static_cast<std::uint64_t>(std::max(number - 1, 0));
    motion.noiseLevels = 2.6;
    motion.picture = tracking::ImageHomography{.errorPx = 0.05};
    motion.picture->currentFromPrevious[2][0] = -pace * step * size.height / 480.0;
    scene::ArFrame frame{.colour = &frames[static_cast<std::size_t>(number % kFrames)],
                         .ids = &ids,
                         .barycentrics = &barycentrics,
                         .forms = &barycentrics,
                         .hasObjects = hasObjects,
                         .sequence = static_cast<std::uint64_t>(number),
                         .captureTime = timeOfFrame(static_cast<std::uint64_t>(number))};
    frame.measuredMotion = scene::MeasuredMotion{.motion = &motion};
    ++number;
    style->paint(frame, "");
  }

  gpu::EglContext context;
  gpu::ShaderLibrary library;
  gpu::PassTimer timer;
  std::unique_ptr<styles::Style> style;
  std::vector<gpu::Texture> frames;
  gpu::Texture ids;
  gpu::Texture barycentrics;
  bool hasObjects = false;
  double pace;
  int number = 0;
  tracking::ImageMotion motion;
};

void wholeStyle(benchmark::State& state, bool hasObjects) {
  Bench bench(sizeOf(state), gpu::PassTiming::kOff);
  bench.hasObjects = hasObjects;
  std::vector<double> times;
  for ([[maybe_unused]] auto _ : state) {
    const auto start = std::chrono::steady_clock::now();
    bench.paint();
    hal::orThrow(gpu::Fence::insert().wait());
    times.push_back(millisecondsSince(start));
  }
  state.counters["median_ms"] = medianOf(times);
}

/// Each pass by itself, before a camera that stands; `movers`: whether they are told apart.
void eachPass(benchmark::State& state, const char* movers) {
  Bench bench(sizeOf(state), gpu::PassTiming::kFences, true);
  bench.style->setParameters(bench.style->parameters().with("movers", movers));
  bench.paint();  // drivers may finish programs at their first use
  timeEachPass(
      state, [&] { return bench.timer.times(); },
      [&] {
        bench.timer.beginFrame();
        bench.paint();
      });
}

void onePass(benchmark::State& state, const char* pass) {
  Bench bench(sizeOf(state), gpu::PassTiming::kFences);
  timePasses(state, bench.timer, {pass}, [&bench] { bench.paint(); });
}

void openCvStylization(benchmark::State& state) {
  const hal::FrameSize size = sizeOf(state);
  std::vector<cv::Mat> frames;
  for (int i = 0; i < kFrames; ++i) {
    std::vector<std::uint8_t> pixels = framePixels(size, i);
    cv::Mat bgr(size.height, size.width, CV_8UC3);
    for (std::size_t p = 0; p < pixels.size() / 4; ++p) {
      for (std::size_t c = 0; c < 3; ++c) bgr.data[p * 3 + c] = pixels[p * 4 + 2 - c];
    }
    frames.push_back(bgr);
  }
  cv::Mat stylized;
  cv::stylization(frames[0], stylized);
  std::vector<double> times;
  std::size_t number = 0;
  for ([[maybe_unused]] auto _ : state) {
    const auto start = std::chrono::steady_clock::now();
    cv::stylization(frames[number++ % kFrames], stylized);
    times.push_back(millisecondsSince(start));
  }
  state.counters["median_ms"] = medianOf(times);
}

BENCHMARK_CAPTURE(wholeStyle, camera, false)->Name("watercolor/whole")->Apply(atBothSizes);
BENCHMARK_CAPTURE(wholeStyle, objects, true)
    ->Name("watercolor/whole with objects")
    ->Apply(atBothSizes);
BENCHMARK_CAPTURE(eachPass, movers, "true")
    ->Name("watercolor/standing, pass by pass")
    ->Apply(atBothSizes);
BENCHMARK_CAPTURE(eachPass, alone, "false")
    ->Name("watercolor/standing, pass by pass, movers not told apart")
    ->Apply(atBothSizes);
BENCHMARK(openCvStylization)->Name("opencv/stylization")->Apply(atBothSizes);
BENCHMARK_CAPTURE(onePass, tile, "watercolor: tile")
    ->Name("watercolor/tile")
    ->Apply(passAtBothSizes);
BENCHMARK_CAPTURE(onePass, cells, "watercolor: cells")
    ->Name("watercolor/cells")
    ->Apply(passAtBothSizes);
BENCHMARK_CAPTURE(onePass, guide, "watercolor: guide")
    ->Name("watercolor/guide")
    ->Apply(passAtBothSizes);
BENCHMARK_CAPTURE(onePass, split, "watercolor: split")
    ->Name("watercolor/split")
    ->Apply(passAtBothSizes);
BENCHMARK_CAPTURE(onePass, pigment, "watercolor: pigment")
    ->Name("watercolor/pigment")
    ->Apply(passAtBothSizes);
BENCHMARK_CAPTURE(onePass, layers, "watercolor: layers")
    ->Name("watercolor/layers")
    ->Apply(passAtBothSizes);
BENCHMARK_CAPTURE(onePass, compose, "watercolor: compose")
    ->Name("watercolor/compose")
    ->Apply(passAtBothSizes);

}  // namespace
