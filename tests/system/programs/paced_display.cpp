// The live pipeline with a camera, a display and a painter that costs next to nothing: what is left
// is the time that frames are handed over, flipped and counted at. Under emulation the engine
// paints too slowly for a camera's rate (scenarios/display_pace.py).
//
// Beside the log of frames, FILE.standstills says when the machine stood still.
//
// usage: paced_display CAMERA RATE FRAMES FILE      as --camera, camera.rate, --frames and
//                                                   runtime.frame_log of pleinair run
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "firmware_app/config/camera_selection.h"
#include "firmware_app/live/runtime_rules.h"
#include "firmware_app/live/status/frame_log_file.h"
#include "hal/outputs/display/display_output.h"
#include "hal/supervisor/camera_supervisor.h"
#include "pipeline/runtime/live_pipeline.h"
#include "pipeline/runtime/live_threads.h"
#include "tests/system/programs/standstills.h"

namespace pleinair {
namespace {

using namespace std::chrono_literals;

/// Paints each frame in one grey: that of its first pixel.
class GreyPainter final : public runtime::FramePainter {
 public:
  hal::Result<void> paint(const hal::CapturedFrame& frame, std::size_t) override {
    for (Open& each : outputs_) {
      each.inFlight.push_back({.sequence = frame.sequence,
                               .captured = frame.captureTime,
                               .grey = frame.image.map().view().planes[0].bytes[0]});
    }
    return {};
  }
  hal::Answer poll(std::size_t output, OutputFrame& frame) override {
    Open& from = outputs_.at(output);
    if (from.inFlight.empty()) return false;
    const Painted& oldest = from.inFlight.front();
    if (frame.image.format() != from.format) frame.image = hal::Image(from.format);
    std::ranges::fill(frame.image.plane(0), oldest.grey);
    frame.sequence = oldest.sequence;
    frame.captureTime = oldest.captured;
    from.inFlight.pop_front();
    return true;
  }
  void wait(hal::Duration limit) override { std::this_thread::sleep_for(limit); }
  void open(std::size_t, const hal::OutputFormat& format) override {
    outputs_.push_back({.format = format.frame, .inFlight = {}});
  }
  void close(std::size_t output) override { outputs_.at(output).inFlight.clear(); }

 private:
  struct Painted {
    std::uint64_t sequence = 0;
    hal::TimePoint captured;
    std::uint8_t grey = 0;
  };
  struct Open {
    hal::FrameFormat format;
    std::deque<Painted> inFlight;
  };
  std::vector<Open> outputs_;
};

int run(const std::string& source, double rate, std::uint64_t frames, const std::string& file) {
  constexpr hal::FrameSize kSize{320, 240};
  hal::SteadyClock clock;
  app::CameraSettings camera;
  camera.source = source;
  camera.framesPerSecond = rate;
  const auto selector = app::makeCameraSelector(camera, clock);
  hal::CameraSupervisor supervisor(*selector, clock, {},
                                   {.size = kSize, .framePeriod = hal::fromSeconds(1.0 / rate)});
  app::FrameLogFile log(file, {"display"});
  runtime::LivePipeline pipeline(supervisor, clock);
  runtime::LiveThreads threads(pipeline);
  while (!pipeline.capture().status().format) std::this_thread::sleep_for(10ms);
  const hal::StreamFormat stream = *pipeline.capture().status().format;

  std::unique_ptr<hal::Output> display = hal::orThrow(
      hal::openDisplay("display", {.mode = "640x480", .placement = {}, .blanking = {}}));
  const hal::OutputRequest request{.size = kSize, .framePeriod = stream.framePeriod};
  const hal::OutputFormat format = hal::orThrow(display->start(request));
  const app::RuntimeSettings settings;
  runtime::OutputStageOptions options = app::outputRules("display", {}, settings, stream);
  options.request = request;
  options.reopen = {};
  options.log = &log.log();
  runtime::OutputStage& output = pipeline.addOutput(std::move(display), format, std::move(options));
  pipeline.makePaintStage([] { return std::make_unique<GreyPainter>(); },
                          app::paintRules(settings, stream));
  threads.startPainter();
  while (!threads.isPainterReady()) std::this_thread::sleep_for(1ms);
  threads.startOutputs();

  Standstills standstills(clock);
  const auto captured = [&] { return pipeline.ledger().counts().captured; };
  const std::uint64_t before = captured();
  const hal::TimePoint began = clock.now();
  while (captured() < before + frames && !output.status().isFailed) {
    std::this_thread::sleep_for(100ms);
    hal::orThrow(log.update());
  }
  const hal::Duration took = clock.now() - began;
  const runtime::LiveThreads::Stopped stopped = threads.stop(1500ms);
  hal::orThrow(log.update());
  standstills.write(file + ".standstills");
  const runtime::DurationHistogram filling = output.status().writing;
  fmt::print("filling a surface takes {:.1f} ms (p50), {:.1f} ms (p95)\n",
             hal::toMilliseconds(filling.percentile(0.5)),
             hal::toMilliseconds(filling.percentile(0.95)));
  fmt::print("{}: display\n", pipeline.ledger().counts().summary(took));
  return stopped.stuck.empty() && stopped.failures.empty() ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace
}  // namespace pleinair

int main(int count, char** values) {
  const std::span arguments(values, static_cast<std::size_t>(count));
  if (arguments.size() != 5) return 2;
  try {
    return pleinair::run(arguments[1], std::stod(arguments[2]), std::stoull(arguments[3]),
                         arguments[4]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return EXIT_FAILURE;
  }
}
