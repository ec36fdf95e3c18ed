// Cost of uploading and reading back frames: wall time from the first call until a fence signals
// that the GPU is done (timer queries lie on the software rasteriser).
#include <array>
#include <cstdint>

#include <benchmark/benchmark.h>

#include "hal/error.h"
#include "hal/image.h"
#include "pipeline/gpu/context/egl_context.h"
#include "pipeline/gpu/frames/frame_upload.h"
#include "pipeline/present/present_shaders.h"
#include "pipeline/present/readback.h"
#include "tests/bench/benchmarks.h"

namespace pleinair {
namespace {

using bench::sizeOf;
using hal::FrameSize;
using hal::PixelFormat;

/// One context for the whole program, on its one thread.
gpu::ShaderLibrary& library() {
  static const gpu::EglContext context;
  static gpu::ShaderLibrary shaders = [] {
    gpu::ShaderLibrary result;
    result.add(gpu::presentShaders());
    return result;
  }();
  return shaders;
}

hal::Image gradient(PixelFormat format, FrameSize size) {
  hal::Image image({.pixelFormat = format, .size = size});
  for (int plane = 0; plane < planeCount(format); ++plane) {
    std::uint32_t i = 0;
    for (auto& byte : image.plane(plane))
      byte = static_cast<std::uint8_t>(i++ * 2654435761U >> 24U);
  }
  return image;
}

void waitForGpu() {
  hal::orThrow(gpu::Fence::insert().wait());
}

/// Warms the pass up, which compiles its shaders, and times it.
template <class Pass>
void timePass(benchmark::State& state, const Pass& pass) {
  for (int warmUp = 0; warmUp < 3; ++warmUp) pass();
  waitForGpu();
  for ([[maybe_unused]] auto _ : state) {
    pass();
    waitForGpu();
  }
}

void uploadAndConvert(benchmark::State& state, PixelFormat format) {
  gpu::FrameUploader uploader(library());
  const hal::Image image = gradient(format, sizeOf(state));
  timePass(state, [&] { uploader.upload(image.view(), image.size()); });
}

void halve(benchmark::State& state) {
  gpu::Resampler resampler(library());
  const FrameSize size = sizeOf(state);
  const gpu::Texture picture(gpu::TextureFormat::kRgba8, size, gpu::TextureFilter::kLinear);
  timePass(state, [&] { resampler.resample(picture, {size.width / 2, size.height / 2}); });
}

void enlargeByHalf(benchmark::State& state) {
  gpu::Resampler resampler(library());
  const FrameSize size = sizeOf(state);
  const FrameSize small{size.width * 2 / 3, size.height * 2 / 3};
  const gpu::Texture picture(gpu::TextureFormat::kRgba8, small, gpu::TextureFilter::kLinear);
  timePass(state, [&] { resampler.resample(picture, size); });
}

void packAndReadBack(benchmark::State& state, PixelFormat format) {
  const FrameSize size = sizeOf(state);
  present::Readback reader(library(), {.pixelFormat = format, .size = size});
  const gpu::Texture picture(gpu::TextureFormat::kRgba8, size, gpu::TextureFilter::kLinear);
  hal::Image image;
  timePass(state, [&] {
    reader.submit(picture);
    hal::orThrow(reader.wait(image));
  });
}

void atBothSizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->Args({640, 480})->Args({1280, 720})->ArgNames({"width", "height"});
  // Process CPU time counts the software rasteriser's threads, and means something under load.
  benchmark->UseRealTime()->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
  benchmark->MinTime(0.1)->Repetitions(9)->ReportAggregatesOnly();
}

BENCHMARK_CAPTURE(uploadAndConvert, nv12, PixelFormat::kNv12)->Apply(atBothSizes);
BENCHMARK_CAPTURE(uploadAndConvert, i420, PixelFormat::kI420)->Apply(atBothSizes);
BENCHMARK_CAPTURE(uploadAndConvert, yuyv, PixelFormat::kYuyv)->Apply(atBothSizes);
BENCHMARK_CAPTURE(uploadAndConvert, rgb8, PixelFormat::kRgb8)->Apply(atBothSizes);
BENCHMARK_CAPTURE(uploadAndConvert, bayer, PixelFormat::kBayerRggb8)->Apply(atBothSizes);
BENCHMARK(halve)->Apply(atBothSizes);
BENCHMARK(enlargeByHalf)->Apply(atBothSizes);
BENCHMARK_CAPTURE(packAndReadBack, i420, PixelFormat::kI420)->Apply(atBothSizes);
BENCHMARK_CAPTURE(packAndReadBack, rgb8, PixelFormat::kRgb8)->Apply(atBothSizes);
BENCHMARK_CAPTURE(packAndReadBack, rgba8, PixelFormat::kRgba8)->Apply(atBothSizes);

}  // namespace
}  // namespace pleinair
