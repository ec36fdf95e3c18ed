#pragma once

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <unistd.h>

#include "hal/camera_backend.h"
#include "hal/file_descriptor.h"
#include "hal/supervisor/camera_selector.h"
#include "hal/supervisor/camera_supervisor.h"
#include "pipeline/runtime/live_pipeline.h"
#include "tests/support/drawn_surface.h"

namespace pleinair::support {

// A live pipeline under a stepped clock: a camera with its own pace, a painter with a simulated GPU
// time, and an output that records its frames. One thread; every run gives the same result.

/// An endless camera with one frame per period, delivered some time after its capture.
struct PacedCameraOptions {
  hal::Duration period = std::chrono::microseconds(33'333);
  std::function<hal::Duration(std::uint64_t)> delay = [](std::uint64_t) {
    return std::chrono::milliseconds(3);
  };
  std::function<hal::FrameHealth(std::uint64_t)> health = [](std::uint64_t) {
    return hal::FrameHealth::kValid;
  };
  std::optional<std::uint64_t> frames;  ///< unset: endless
  hal::FrameSize size{8, 6};
  /// Draws a frame over the one before; null: all are black.
  std::function<void(std::uint64_t, hal::Image&)> draw;
};

class PacedCamera final : public hal::Camera {
 public:
  PacedCamera(PacedCameraOptions options, hal::Clock& clock)
      : options_(std::move(options)),
        clock_(clock),
        image_(std::make_shared<hal::Image>(format())) {}

  hal::CameraIdentity identity() const override { return {"paced", "paced", "paced"}; }
  hal::Result<hal::StreamFormat> start(const hal::StreamRequest&) override {
    started_ = clock_.now();
    next_ = 0;
    return hal::StreamFormat{.frame = format(), .framePeriod = options_.period};
  }
  hal::NextFrame next(hal::TimePoint deadline) override {
    if (options_.frames && next_ == *options_.frames) return hal::EndOfStream{};
    const hal::TimePoint captured = started_ + next_ * options_.period;
    const hal::TimePoint arrival = captured + options_.delay(next_);
    clock_.sleepUntil(std::min(arrival, deadline));
    if (clock_.now() < arrival) return hal::CameraTimeout{};
    const std::uint64_t sequence = next_++;
    if (options_.draw) options_.draw(sequence, *image_);
    return hal::CapturedFrame{.image = image_->view(),
                              .sequence = sequence,
                              .captureTime = captured,
                              .health = options_.health(sequence),
                              .lease = image_};
  }
  void stop() override {}

 private:
  hal::FrameFormat format() const {
    return {.pixelFormat = hal::PixelFormat::kGrey8, .size = options_.size};
  }

  PacedCameraOptions options_;
  hal::Clock& clock_;
  std::shared_ptr<hal::Image> image_;
  hal::TimePoint started_;
  std::uint64_t next_ = 0;
};

/// A back end with a single camera.
class SingleBackend final : public hal::CameraBackend {
 public:
  using Make = std::function<std::unique_ptr<hal::Camera>(hal::Clock&)>;
  explicit SingleBackend(Make make) : make_(std::move(make)) {}
  std::string_view name() const override { return "single"; }
  hal::Result<std::vector<hal::CameraDescription>> list() override {
    return std::vector<hal::CameraDescription>{{.identity = {"single", "only", "the only one"},
                                                .serial = {},
                                                .node = {},
                                                .modes = {},
                                                .problem = {}}};
  }
  std::unique_ptr<hal::Camera> make(const std::string&, hal::Clock& clock) override {
    return make_(clock);
  }

 private:
  Make make_;
};

inline hal::CameraSelector selectorOf(SingleBackend::Make make, hal::Clock& clock,
                                      bool isDevice = false) {
  std::vector<hal::SelectableBackend> backends;
  backends.push_back({std::make_unique<SingleBackend>(std::move(make)), isDevice});
  return {std::move(backends), "single", clock};
}

/// A simulated GPU, shared by the painters of one pipeline, which come and go.
struct SimulatedGpu {
  /// GPU time of a frame at a quality level.
  std::function<hal::Duration(std::uint64_t sequence, std::size_t quality)> cost =
      [](std::uint64_t, std::size_t) { return std::chrono::milliseconds(20); };
  std::function<bool(std::uint64_t sequence)> isLostAt = [](std::uint64_t) { return false; };
  int failingStarts = 0;  ///< how many of the next painters cannot be created
  int widest = 4096;      ///< output that it can paint for
  int painters = 0;       ///< that exist now
  int made = 0;
  std::optional<hal::TimePoint> nextReady;
  bool isLost = false;
  std::uint8_t painted = 0;  ///< every byte of what is read back: black

  // Of painting straight into surfaces; the pixels of a frame are kDrawn + its sequence number.

  static constexpr std::uint32_t kDrawn = 0x00500000;
  std::vector<std::uint64_t> drawable;    ///< layouts; empty: it only reads back
  void* eglDisplay = nullptr;             ///< whose textures it draws into
  std::string apartBecause;               ///< why that is not the window's
  std::optional<hal::Error> importError;  ///< of every import
  bool drawsWrong = false;                ///< a pixel of what it draws into surfaces is another
  int imports = 0;
};

/// Paints one frame after another.
class SimulatedPainter final : public runtime::FramePainter {
 public:
  SimulatedPainter(SimulatedGpu& gpu, hal::Clock& clock) : gpu_(gpu), clock_(clock) {
    ++gpu_.painters;
    ++gpu_.made;
    gpu_.nextReady.reset();
    gpu_.isLost = false;
  }
  ~SimulatedPainter() override {
    --gpu_.painters;
    gpu_.nextReady.reset();
  }

  hal::Result<void> paint(const hal::CapturedFrame& frame, std::size_t quality) override {
    if (gpu_.isLostAt(frame.sequence)) gpu_.isLost = true;
    if (gpu_.isLost) return tl::unexpected(lost());
    busyUntil_ = std::max(busyUntil_, clock_.now()) + gpu_.cost(frame.sequence, quality);
    work_.push_back({frame.sequence, frame.captureTime, busyUntil_, std::exchange(next_, {})});
    tellNext();
    return {};
  }

  hal::Answer poll(std::size_t output, OutputFrame& picture) override {
    if (gpu_.isLost) return tl::unexpected(lost());
    const std::size_t index = taken_.at(output).value() - done_;
    if (index >= work_.size() || work_.at(index).ready > clock_.now()) return false;
    picture.sequence = work_.at(index).sequence;
    picture.captureTime = work_.at(index).captured;
    picture.surface = drawIfWanted(work_.at(index), output);
    const hal::FrameFormat& format = formats_.at(output).frame;
    if (picture.image.format() != format) picture.image = hal::Image(format);
    std::ranges::fill(picture.image.plane(0), gpu_.painted);
    ++*taken_.at(output);
    forgetTaken();
    return true;
  }
  void wait(hal::Duration) override {}  // who steps the clock knows nextReady

  void open(std::size_t output, const hal::OutputFormat& format) override {
    assert(output == taken_.size());
    if (format.frame.size.width > gpu_.widest) {
      throw hal::Failure({.kind = hal::ErrorKind::kUnsupported,
                          .subject = "GPU",
                          .problem = "does not paint so wide"});
    }
    formats_.push_back(format);
    taken_.emplace_back(done_ + work_.size());
  }
  void close(std::size_t output) override {
    taken_.at(output).reset();
    loans_.erase(output);
    forgetTaken();
  }

  runtime::DrawableLayouts drawable() override {
    return {gpu_.drawable, "draws nowhere else", gpu_.eglDisplay, gpu_.apartBecause};
  }
  hal::Result<void> importLoan(std::size_t output, const runtime::SurfaceLoan& loan) override {
    ++gpu_.imports;
    if (gpu_.isLost) return tl::unexpected(lost());
    if (gpu_.importError) return tl::unexpected(*gpu_.importError);
    Loan& mine = loans_[output];
    mine = {.number = loan.number, .surfaces = loan.surfaces, .descriptors = {}};
    for (hal::GpuSurface& each : mine.surfaces) {
      hal::SurfacePlane& plane = each.surface.planes[0];
      plane.dmaBuf = ::dup(plane.dmaBuf);
      mine.descriptors.emplace_back(plane.dmaBuf);
      drawPatternInto(each);
      if (!gpu_.drawsWrong) continue;
      drawInto(each, [](int x, int) { return static_cast<std::uint32_t>(x); });
    }
    return {};
  }
  void drawNextInto(std::size_t output, const hal::LentSurface& surface) override {
    next_[output] = surface;
  }

 private:
  using Into = std::map<std::size_t, hal::LentSurface>;  ///< by output
  struct Work {
    std::uint64_t sequence;
    hal::TimePoint captured;
    hal::TimePoint ready;
    Into into;
  };
  struct Loan {
    std::uint64_t number = 0;
    std::vector<hal::GpuSurface> surfaces;
    std::vector<hal::FileDescriptor> descriptors;
  };
  std::optional<hal::LentSurface> drawIfWanted(const Work& work, std::size_t output) {
    const auto into = work.into.find(output);
    if (into == work.into.end()) return std::nullopt;
    const Loan& loan = loans_.at(output);
    assert(loan.number == into->second.loan);
    for (const hal::GpuSurface& each : loan.surfaces) {
      if (each.surface.id != into->second.id) continue;
      drawInto(each, [&](int, int) {
        return SimulatedGpu::kDrawn + static_cast<std::uint32_t>(work.sequence);
      });
      return into->second;
    }
    assert(false);
    return std::nullopt;
  }
  static hal::Error lost() {
    return {.kind = hal::ErrorKind::kDeviceLost, .subject = "GPU", .problem = "was lost"};
  }
  void forgetTaken() {
    const auto hasIt = [&](const auto& taken) { return !taken || *taken > done_; };
    while (!work_.empty() && std::ranges::all_of(taken_, hasIt)) {
      work_.pop_front();
      ++done_;
    }
    tellNext();
  }
  void tellNext() {
    gpu_.nextReady = work_.empty() ? std::nullopt : std::optional(work_.front().ready);
  }

  SimulatedGpu& gpu_;
  std::vector<hal::OutputFormat> formats_;
  hal::Clock& clock_;
  hal::TimePoint busyUntil_;
  Into next_;
  std::map<std::size_t, Loan> loans_;
  std::deque<Work> work_;
  std::size_t done_ = 0;
  std::vector<std::optional<std::size_t>> taken_;  ///< of each output; none of closed ones
};

/// Records the time and the number of each frame that it gets.
class CapturingOutput final : public hal::MemoryOutput {
 public:
  struct Note {
    hal::Duration time;  ///< capture time, counted from the first frame's
    hal::TimePoint presented;
    friend bool operator==(const Note&, const Note&) = default;
  };
  CapturingOutput(std::vector<Note>& notes, hal::Clock& clock,
                  std::optional<hal::Refresh> refresh = std::nullopt)
      : notes_(notes), clock_(clock), refresh_(refresh) {}
  hal::OutputIdentity identity() const override { return {"noting", "noting"}; }
  hal::Result<hal::OutputFormat> start(const hal::OutputRequest& request) override {
    return hal::OutputFormat{
        .frame = {.pixelFormat = hal::PixelFormat::kGrey8, .size = request.size},
        .refresh = refresh_};
  }
  hal::Result<hal::OutputFormat> reconfigure(const hal::OutputRequest& request) override {
    return start(request);
  }
  hal::Result<void> write(const hal::ImageView&, hal::Duration time) override {
    notes_.push_back({time, clock_.now()});
    return {};
  }
  hal::Result<void> finish() override { return {}; }

 private:
  std::vector<Note>& notes_;
  hal::Clock& clock_;
  std::optional<hal::Refresh> refresh_;
};

/// The pipeline, with all stages stepped in turn.
class LiveSimulation {
 public:
  hal::SteppedClock clock{hal::TimePoint(std::chrono::seconds(100))};
  SimulatedGpu gpu;
  runtime::PaintStageOptions painting{.governor = {.levels = 5, .pinned = {}},
                                      .latency = {},
                                      .framePeriod = std::chrono::microseconds(33'333)};
  std::vector<CapturingOutput::Note> notes;

  /// Begins with this camera; `makeOutput` adds another output.
  void begin(hal::CameraSelector& selector, std::size_t waiting = 16,
             std::optional<hal::Refresh> refresh = std::nullopt) {
    supervisor_ = std::make_unique<hal::CameraSupervisor>(selector, clock);
    chain = std::make_unique<runtime::LivePipeline>(*supervisor_, clock);
    while (!chain->capture().status().format) chain->capture().step(clock.now());
    addOutput({.name = "noting", .waiting = waiting}, refresh);
  }
  runtime::OutputStage& addOutput(runtime::OutputStageOptions options,
                                  std::optional<hal::Refresh> refresh = std::nullopt) {
    return addOutput(std::make_unique<CapturingOutput>(notes, clock, refresh), std::move(options));
  }
  runtime::OutputStage& addOutput(std::unique_ptr<hal::Output> output,
                                  runtime::OutputStageOptions options) {
    const auto format = *output->start({.size = {8, 6}});
    return chain->addOutput(std::move(output), format, std::move(options));
  }
  void start() {
    chain->makePaintStage(
        [this]() -> std::unique_ptr<runtime::FramePainter> {
          if (gpu.failingStarts > 0) {
            --gpu.failingStarts;
            throw hal::Failure({.kind = hal::ErrorKind::kUnsupported,
                                .subject = "GPU",
                                .problem = "is still gone"});
          }
          return std::make_unique<SimulatedPainter>(gpu, clock);
        },
        painting);
    chain->paint().start();
    chain->capture().open();
  }

  void runFor(hal::Duration duration) { runUntil(clock.now() + duration); }
  void runUntil(hal::TimePoint end) {
    while (clock.now() < end) {
      stepAll();
      chain->capture().step(nextEvent(end));
    }
    stepAll();
  }
  /// Runs until the camera has ended and all of its frames are done.
  void drain() {
    while (!chain->isDrained()) runFor(std::chrono::milliseconds(10));
  }

  std::unique_ptr<runtime::LivePipeline> chain;

 private:
  void stepAll() {
    wake_.reset();
    do {
      for (std::size_t i = 0; i < chain->outputCount(); ++i) {
        if (const auto next = chain->output(i).step())
          wake_ = wake_ ? std::min(*wake_, *next) : next;
      }
    } while (chain->paint().step());
    for (std::size_t i = 0; i < chain->outputCount(); ++i) {
      if (const auto next = chain->output(i).step()) wake_ = wake_ ? std::min(*wake_, *next) : next;
    }
  }
  /// The next time at which any part but the camera has work to do.
  hal::TimePoint nextEvent(hal::TimePoint end) const {
    // A part without a time of its own (a painter that is to be recreated) is polled at this
    // interval.
    hal::TimePoint next = std::min(end, clock.now() + std::chrono::milliseconds(20));
    if (gpu.nextReady) next = std::min(next, std::max(*gpu.nextReady, clock.now()));
    if (wake_) next = std::min(next, std::max(*wake_, clock.now()));
    return next;
  }

  std::optional<hal::TimePoint> wake_;
  std::unique_ptr<hal::CameraSupervisor> supervisor_;
};

}  // namespace pleinair::support
