// The GPU's time for a frame, by timer queries, of whole styles on the workbench; beside it the
// processor's time, and how long a frame takes where the next is not begun before it is done. Where
// the driver has no usable timer queries (docs/gpu.md, rule 13), each benchmark says so and ends.
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <GLES3/gl31.h>
#include <benchmark/benchmark.h>

#include "firmware_app/scene/workbench_scene.h"
#include "hal/cameras/synthetic/synthetic_camera.h"
#include "pipeline/engine/painter.h"
#include "pipeline/gpu/handle.h"
#include "pipeline/scene/description/scene_file.h"
#include "tests/bench/benchmarks.h"
#include "tests/bench/workbench_film.h"

namespace {

using namespace pleinair;         // NOLINT(google-build-using-namespace): a program, not a header
using namespace pleinair::bench;  // NOLINT(google-build-using-namespace)

constexpr std::uint64_t kFrames = 8;

/// The workbench's frames of one size, which take the processor long at 4K: made once.
const std::vector<hal::CapturedFrame>& workbench(hal::FrameSize size) {
  static std::map<std::pair<int, int>, std::vector<hal::CapturedFrame>> made;
  std::vector<hal::CapturedFrame>& frames = made[{size.width, size.height}];
  if (!frames.empty()) return frames;
  frames = workbenchFilm(size, kFrames);
  return frames;
}

scene::Scene gearboxOf(hal::FrameSize size) {
  hal::SteppedClock clock;
  const hal::SyntheticCamera camera({.size = size, .frameCount = 1}, clock);
  return scene::parseScene(app::workbenchScene(camera.truth(0), size), "bench", {});
}

struct Setting {
  const char* style = "painterly";
  bool hasModel = false;
  /// Parameters of the style other than they are by themselves.
  std::vector<std::pair<const char*, const char*>> values;
};

class Bench {
 public:
  Bench(hal::FrameSize size, const Setting& setting, gpu::PassTiming timing)
      : frames_(workbench(size)),
        painter_({.pictureSize = size,
                  .scene = setting.hasModel ? gearboxOf(size) : scene::Scene{},
                  .style = setting.style,
                  .tracksTags = setting.hasModel,
                  .passTiming = timing}),
        parameters_(painter_.defaultParameters()) {
    for (const auto& [name, value] : setting.values) {
      parameters_.style = parameters_.style.with(name, value);
    }
    for (int i = 0; i < 8; ++i) paint();
    waitForGpu();
  }
  void paint() {
    hal::CapturedFrame frame = frames_[forthAndBack(number_, kFrames)];
    frame.sequence = number_;
    frame.captureTime = timeOfFrame(number_);
    ++number_;
    hal::orThrow(painter_.paint(frame, parameters_));
  }
  void waitForGpu() { hal::orThrow(gpu::Fence::insert().wait()); }
  const Painter& painter() const { return painter_; }
  double strokes() const {
    double alive = 0;
    for (const marks::Anchor& each : hal::orThrow(painter_.anchors())) alive += each.isAlive();
    return alive;
  }

 private:
  const std::vector<hal::CapturedFrame>& frames_;
  Painter painter_;
  PaintParameters parameters_;
  std::uint64_t number_ = 0;
};

/// Other work for the GPU while the processor tracks: a card that is at rest for most of a frame
/// lowers its clocks, and every pass then reads as many times as long (six, of one card).
class Filler {
 public:
  Filler() {
    const GLuint shader = glCreateShader(GL_COMPUTE_SHADER);
    glShaderSource(shader, 1, &kText, nullptr);
    glCompileShader(shader);
    program_ = glCreateProgram();
    glAttachShader(program_, shader);
    glLinkProgram(program_);
    glDeleteShader(shader);
    GLint isLinked = GL_FALSE;
    glGetProgramiv(program_, GL_LINK_STATUS, &isLinked);
    if (isLinked == GL_FALSE) throw std::runtime_error("the filler does not link");
    glGenBuffers(1, &buffer_);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer_);
    glBufferData(GL_SHADER_STORAGE_BUFFER, sizeof(float) * 64 * kGroups, nullptr, GL_DYNAMIC_COPY);
    const auto warm = std::chrono::steady_clock::now();
    while (millisecondsSince(warm) < 1000.0) millisecondsOf();
    while (rounds_ < kMostRounds && millisecondsOf() < kMilliseconds) rounds_ *= 2;
  }
  Filler(const Filler&) = delete;
  Filler& operator=(const Filler&) = delete;
  ~Filler() {
    glDeleteProgram(program_);
    glDeleteBuffers(1, &buffer_);
  }
  void issue() const {
    glUseProgram(program_);
    glUniform1i(0, rounds_);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer_);
    glDispatchCompute(kGroups, 1, 1);
    glFlush();
  }

  double millisecondsOf() const {
    const auto start = std::chrono::steady_clock::now();
    issue();
    glFinish();
    return millisecondsSince(start);
  }

 private:
  static constexpr GLuint kGroups = 512;
  static constexpr double kMilliseconds = 5.0;
  static constexpr int kMostRounds = 1 << 24;
  static constexpr const char* kText = R"(#version 310 es
layout(local_size_x = 64) in;
layout(location = 0) uniform int rounds;
layout(std430, binding = 0) buffer Numbers { highp float numbers[]; };
void main() {
  highp float x = numbers[gl_GlobalInvocationID.x];
  for (int i = 0; i < rounds; ++i) x = fract(x * 1.61803 + 0.31831);
  numbers[gl_GlobalInvocationID.x] = x;
}
)";

  GLuint program_ = 0, buffer_ = 0;
  int rounds_ = 1000;
};

double processMilliseconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

/// Each pass's mean, ms a frame, as a counter; the iteration's time is their sum.
void byQueries(benchmark::State& state, const Setting& setting) {
  Bench bench(sizeOf(state), setting, gpu::PassTiming::kQueries);
  const gpu::ContextInfo& context = bench.painter().contextInfo();
  if (!context.hasTimerQuery || context.isSoftware) {
    state.SkipWithError((context.renderer + " has no usable timer queries").c_str());
    return;
  }
  state.SetLabel(context.renderer);
  using Milliseconds = std::chrono::duration<double, std::milli>;
  std::map<std::string, double> totals;
  const auto read = [&] {  // the passes' sum since it was last asked
    double sum = 0.0;
    for (const gpu::PassTime& each : bench.painter().passTimes()) {
      const double total = Milliseconds(each.total).count();
      sum += total - std::exchange(totals[each.pass], total);
    }
    return sum;
  };
  const Filler filler;
  state.counters["filler"] = filler.millisecondsOf();
  read();
  const std::map<std::string, double> before = totals;
  for ([[maybe_unused]] auto _ : state) {
    filler.issue();
    bench.paint();
    bench.waitForGpu();
    state.SetIterationTime(1e-3 * read());  // of the frame before: queries are read at the next
  }
  for (const auto& [pass, total] : totals) {
    const auto earlier = before.find(pass);
    const double since = total - (earlier == before.end() ? 0.0 : earlier->second);
    state.counters[pass] = since / static_cast<double>(state.iterations());
  }
  if (const double strokes = bench.strokes(); strokes > 0) state.counters["strokes"] = strokes;
}

/// Frames issued one after the other, none waited for but the last.
void oneAfterTheOther(benchmark::State& state, const Setting& setting) {
  constexpr int kRun = 30;
  Bench bench(sizeOf(state), setting, gpu::PassTiming::kOff);
  state.SetLabel(bench.painter().contextInfo().renderer);
  double cpu = 0.0;
  for ([[maybe_unused]] auto _ : state) {
    const auto start = std::chrono::steady_clock::now();
    const double cpuStart = processMilliseconds();
    for (int i = 0; i < kRun; ++i) bench.paint();
    bench.waitForGpu();
    cpu += processMilliseconds() - cpuStart;
    state.SetIterationTime(1e-3 * millisecondsSince(start) / kRun);
  }
  state.counters["cpu_ms"] = cpu / kRun / static_cast<double>(state.iterations());
}

void atSizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->Args({640, 480})->Args({1920, 1080})->Args({3840, 2160});
  benchmark->Unit(benchmark::kMillisecond)->UseManualTime();
}

void gpuTime(benchmark::internal::Benchmark* benchmark) {
  atSizes(benchmark);
  benchmark->Iterations(60);
}

void wallTime(benchmark::internal::Benchmark* benchmark) {
  atSizes(benchmark);
  benchmark->Iterations(3);
}

/// One layer, which is everywhere, of many strokes.
Setting manyStrokes() {
  return {.values = {{"layers", "1"}, {"stroke_size", "2"}, {"coverage", "8"}}};
}

BENCHMARK_CAPTURE(byQueries, painterly, Setting{})->Name("gpu/painterly")->Apply(gpuTime);
BENCHMARK_CAPTURE(byQueries, models, Setting{.hasModel = true})
    ->Name("gpu/painterly, gearbox")
    ->Apply(gpuTime);
BENCHMARK_CAPTURE(byQueries, many, manyStrokes())->Name("gpu/many strokes")->Apply(gpuTime);
BENCHMARK_CAPTURE(byQueries, watercolor, Setting{.style = "watercolor"})
    ->Name("gpu/watercolor")
    ->Apply(gpuTime);
BENCHMARK_CAPTURE(byQueries, hatching, Setting{.style = "hatching"})
    ->Name("gpu/hatching")
    ->Apply(gpuTime);
BENCHMARK_CAPTURE(oneAfterTheOther, painterly, Setting{})->Name("wall/painterly")->Apply(wallTime);
BENCHMARK_CAPTURE(oneAfterTheOther, models, Setting{.hasModel = true})
    ->Name("wall/painterly, gearbox")
    ->Apply(wallTime);
BENCHMARK_CAPTURE(oneAfterTheOther, watercolor, Setting{.style = "watercolor"})
    ->Name("wall/watercolor")
    ->Apply(wallTime);

}  // namespace
