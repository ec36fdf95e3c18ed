#include "firmware_app/live/live_painting.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "firmware_app/cli/compile_notice.h"
#include "firmware_app/cli/exit_status.h"
#include "firmware_app/cli/interrupt.h"
#include "firmware_app/cli/stale_parts.h"
#include "firmware_app/cli/standard_streams.h"
#include "firmware_app/config/camera_selection.h"
#include "firmware_app/config/requested_parts.h"
#include "firmware_app/live/live_controls.h"
#include "firmware_app/live/live_keys.h"
#include "firmware_app/live/live_painter.h"
#include "firmware_app/live/live_reporter.h"
#include "firmware_app/live/live_tuning.h"
#include "firmware_app/live/live_window.h"
#include "firmware_app/live/runtime_rules.h"
#include "firmware_app/live/screens.h"
#include "firmware_app/live/snapshot_saver.h"
#include "firmware_app/scene/scene_warnings.h"
#include "hal/console/virtual_terminal.h"
#include "hal/outputs/display/display_output.h"
#include "hal/outputs/window/window.h"
#include "hal/supervisor/camera_supervisor.h"
#include "hal/supervisor/hotplug_monitor.h"
#include "pipeline/engine/painter.h"
#include "pipeline/runtime/live_pipeline.h"
#include "pipeline/runtime/live_threads.h"
#include "pipeline/runtime/status_text.h"
#include "pipeline/styles/registry.h"

namespace pleinair::app {
namespace {

using hal::orThrow;
using namespace std::chrono_literals;

/// How often the main thread polls keys, signals and the state of the pipeline.
constexpr hal::Duration kPollInterval = 10ms;
constexpr hal::Duration kReportInterval = 100ms;
constexpr hal::Duration kCaptionInterval = 33ms;
/// A change of what is waited for is seen on screens after this.
constexpr hal::Duration kScreensInterval = 50ms;
/// How long a screen may take to another mode before painting begins without it.
constexpr hal::Duration kModePatience = 3s;
/// The stream before there is a camera: the queues of screens are made for fast ones.
constexpr hal::Duration kShortestPeriod = 4ms;
constexpr hal::FrameSize kUsualSize{1280, 720};
/// From this many frames a second on, the next image draws the caption soon enough.
constexpr double kMinCaptionRate = 8.0;
/// Part of the two seconds that ending may take; the rest is for the exit itself.
constexpr hal::Duration kStopPatience = 1500ms;

LiveTuning tuningOf(const PaintingOptions& options) {
  const styles::StyleKind& info = styles::styleKind(options.style);
  std::vector<LiveLook> looks;
  for (const styles::Look& look : info.looks) {
    looks.push_back({std::string(look.name), info.parametersOf(look.name)});
  }
  return {options.style, startParameters(options), debugViewsOf(options.style), std::move(looks)};
}

/// The live pipeline with its window, status server, snapshots and reports. Main thread.
class LivePainting {
 public:
  explicit LivePainting(const LiveJob& job)
      : job_(job),
        supervisor_(*job.selector, *job.clock, {}, job.request),
        pipeline_(supervisor_, *job.clock),
        tuning_(tuningOf(job.options)),
        controls_(startParameters(job.options)),
        saver_(job.snapshots),
        reporter_(qualityNames()),
        screens_(job.selector->choice(), job.state, *job.clock) {
    if (std::ranges::any_of(job.outputs, isOnConsole)) takeConsole();
    if (job.keyboards) {
      keys_.emplace(*job.keyboards, hal::kernelKeyboards(), tuning_, *job.clock);
    }
    for (const std::string& name : job.outputs) {
      orThrow(checkOutputFolder(name));  // now, because the camera may come much later
      opened_.push_back(orThrow(job.openOutput(name)));
    }
  }
  ~LivePainting() { stopThreads(); }
  LivePainting(const LivePainting&) = delete;
  LivePainting& operator=(const LivePainting&) = delete;

  void run() {
    try {
      paintUntilEnd();
    } catch (...) {
      // Threads end here, where the error is known that decides the exit status should one hang.
      stopThreads();
      throw;
    }
    finish();
  }

 private:
  void paintUntilEnd() {
    began_ = job_.clock->now();
    openScreens();  // before the camera, which the camera thread opens
    threads_.emplace(pipeline_);
    for (runtime::OutputStage* each : screens_.stages()) threads_->startOutput(*each);
    std::string why;
    hotplug_ = watchDevices([this](const hal::DeviceEvent& event) { devicesChanged(event); }, why);
    if (!hotplug_) spdlog::debug("no hot-plug events: {}", why);
    waitingSince_ = began_;
    if (job_.serveStatus) server_ = job_.serveStatus(statusPages());
    if (awaitStream()) {
      startOutputs();
      if (awaitPainter()) paint();
    }
  }

  /// Any thread.
  void devicesChanged(const hal::DeviceEvent& event) {
    if (event.subsystem == "drm") {
      haveDisplaysChanged_ = true;
    } else if (event.subsystem == "input") {
      if (keys_) keys_->devicesChanged();
    } else {
      supervisor_.devicesChanged();
    }
  }

  bool isScreen(const std::string& target) const {
    return job_.showsWaiting && orThrow(hal::outputKindOf(target))->traits.showsWaiting;
  }

  void openScreens() {
    stream_ = {.frame = {.pixelFormat = hal::PixelFormat::kRgb8,
                         .size = job_.request.size.value_or(kUsualSize),
                         .encoding = {}},
               .framePeriod = job_.request.framePeriod,
               .frameCount = {}};
    for (std::size_t i = 0; i < opened_.size(); ++i) {
      if (isScreen(job_.outputs[i])) screens_.add(startOutput(i));
    }
    if (screens_.isEmpty()) return;
    updateScreens();
    screens_.showFirst(*job_.clock);
  }

  void updateScreens() {
    if (haveDisplaysChanged_.exchange(false)) retryOutputs();
    if (screens_.isEmpty()) return;
    const hal::TimePoint now = job_.clock->now();
    if (now - screensUpdated_ < kScreensInterval) return;
    screensUpdated_ = now;
    const bool isMade = isPipelineMade_.load(std::memory_order_acquire);
    const auto painting = isMade ? pipeline_.paint().status() : runtime::PaintStage::Status();
    screens_.update({.camera = pipeline_.capture().status(),
                     .hasBegun = hasBegun_,
                     .hasPainter = painting.hasPainter,
                     .painted = painting.painted});
    reportKeeping();
  }

  void reportKeeping() {
    const std::optional<hal::Error> failure = screens_.takeFailure();
    if (!failure) return;
    reporter_.interrupt();
    spdlog::warn("the last painting: {}", failure->message());
  }

  /// Has the screens, which were opened without knowing the stream, take it.
  void reconfigureScreens() {
    const std::vector<runtime::OutputStage*> stages = screens_.stages();
    for (runtime::OutputStage* each : stages) each->reconfigure(outputRequest());
    const hal::TimePoint deadline = job_.clock->now() + kModePatience;
    const auto isDone = [](const runtime::OutputStage* each) { return each->isReconfigured(); };
    while (!std::ranges::all_of(stages, isDone) && job_.clock->now() < deadline) {
      job_.clock->sleepUntil(job_.clock->now() + kPollInterval);
    }
  }

  /// Returns false if a signal ended the wait.
  bool awaitStream() {
    for (;;) {
      attend();
      if (Interrupt::received() != 0 || wantsToQuit_) return false;
      const runtime::CaptureStage::Status camera = pipeline_.capture().status();
      if (camera.format) {
        stream_ = *camera.format;
        return true;
      }
      const bool gaveUp = camera.hasEnded || (camera.cause && !job_.waitsForCamera);
      if (gaveUp) throw hal::Failure(camera.cause.value_or(noFrames()));
      if (camera.cause) reportWaiting(camera.cause->message());
      updateScreens();
      job_.clock->sleepUntil(job_.clock->now() + kPollInterval);
    }
  }

  static hal::Error noFrames() {
    return {.kind = hal::ErrorKind::kInvalidInput,
            .subject = "camera",
            .problem = "has ended before its first frame",
            .remedy = {}};
  }

  void reportWaiting(const std::string& cause) {
    if (std::exchange(waitingCause_, cause) != cause)
      spdlog::warn("waiting for a camera: {}", cause);
  }

  hal::FrameSize pictureSize() const { return job_.options.size.value_or(stream_.frame.size); }

  void startOutputs() {
    for (const std::string& notice : job_.scene.notices) spdlog::warn("{}", notice);
    for (const auto& warning : {assumedCameraWarning(job_.scene, stream_.frame.size),
                                blackViewWarning(job_.scene, job_.options.view)}) {
      if (warning) spdlog::warn("{}", *warning);
    }
    reconfigureScreens();
    for (std::size_t i = 0; i < opened_.size(); ++i) {
      if (!isScreen(job_.outputs[i])) startOutput(i);
    }
    for (const std::string& target : job_.outputs) {
      if (!orThrow(hal::outputKindOf(target))->traits.writesFiles) continue;
      for (const std::string& notice : stalePartNotices(target)) spdlog::warn("{}", notice);
    }
    pipeline_.makePaintStage([this](const auto& formats) { return makePainter(formats); },
                             paintRules(job_.runtime, stream_));
    threads_->startPainter();
    isPipelineMade_.store(true, std::memory_order_release);
  }

  /// Any thread. Before the camera's first frame there are neither outputs nor a painter.
  runtime::RuntimeStatus statusNow() {
    if (isPipelineMade_.load(std::memory_order_acquire)) return pipeline_.status();
    runtime::RuntimeStatus status{.uptime = job_.clock->now() - waitingSince_,
                                  .camera = pipeline_.capture().status(),
                                  .painting = {},
                                  .outputs = {},
                                  .ledger = pipeline_.ledger().counts()};
    const std::optional<hal::Error>& cause = status.camera.cause;
    status.camera.reason =
        "waiting for a camera: " + (cause ? cause->message() : status.camera.reason);
    return status;
  }

  StatusPages statusPages() {
    return {.json = [this] { return runtime::statusJson(statusNow(), qualityNames()); },
            .metrics = [this] { return runtime::statusMetrics(statusNow(), qualityNames()); },
            .healthy = [this] { return statusNow().isHealthy(); }};
  }

  /// Whether an output that cannot be opened may be there later.
  static bool mayCome(const hal::Error& error) {
    using enum hal::ErrorKind;
    return error.kind == kNotFound || error.kind == kDeviceLost || error.kind == kBusy;
  }

  hal::OutputRequest outputRequest() const {
    return {.size = pictureSize(), .framePeriod = stream_.framePeriod};
  }

  runtime::OutputStage& startOutput(std::size_t index) {
    const hal::OutputRequest request = outputRequest();
    auto* window = dynamic_cast<hal::Window*>(opened_.at(index).get());
    const std::string& target = job_.outputs.at(index);
    const hal::OutputKind& kind = *orThrow(hal::outputKindOf(target));
    hal::StreamFormat stream = stream_;
    if (isScreen(target)) stream.framePeriod = kShortestPeriod;
    runtime::OutputStageOptions options =
        outputRules(target, job_.openOutput, job_.runtime, stream);
    options.request = request;
    options.keepsLastFrame = isScreen(target);
    options.limit = job_.options.frames;
    hal::Result<hal::OutputFormat> started = opened_.at(index)->start(request);
    if (!started && job_.waitsForOutputs && kind.traits.reopens && mayCome(started.error())) {
      spdlog::warn("waiting for an output: {}", started.error().message());
      options.absence = std::move(started.error());
      opened_.at(index).reset();
      started = hal::OutputFormat{
          .frame = {.pixelFormat = hal::PixelFormat::kRgba8, .size = request.size},
          .refresh = std::nullopt};
    }
    const hal::OutputFormat format = orThrow(std::move(started));
    if (window != nullptr) window_.emplace(*window, tuning_, *job_.clock);
    runtime::OutputStage& output =
        pipeline_.addOutput(std::move(opened_.at(index)), format, std::move(options));
    if (kind.traits.isOnMainThread) stepped_.push_back(&output);
    return output;
  }

  std::unique_ptr<runtime::FramePainter> makePainter(
      const std::vector<hal::OutputFormat>& formats) {
    const PainterOptions options{.pictureSize = pictureSize(),
                                 .scene = job_.scene,
                                 .style = job_.options.style,
                                 .tracksTags = !job_.scene.tags.empty(),
                                 .shaderDirectory = job_.options.shaderDirectory,
                                 .passTiming = gpu::PassTiming::kSampled,
                                 .expectedFormat = stream_.frame,
                                 .qualityLevels = job_.runtime.quality != qualityNames().front(),
                                 .isCancelled = cancelledBySignal()};
    return std::make_unique<LivePainter>(options, formats, controls_);
  }

  bool awaitPainter() {
    while (Interrupt::received() == 0 && !wantsToQuit_) {
      if (threads_->isPainterReady()) return true;
      updateScreens();
      attend();
      job_.clock->sleepUntil(job_.clock->now() + kPollInterval);
    }
    return false;
  }

  void paint() {
    hasBegun_ = true;
    threads_->startOutputs({stepped_.begin(), stepped_.end()});
    began_ = job_.clock->now();
    while (!isOver()) poll();
  }

  bool isOver() const {
    return Interrupt::received() != 0 || wantsToQuit_ || failure_ || haveOutputsEnded() ||
           pipeline_.isDrained();
  }

  /// Whether each output has got its frames or has failed for good.
  bool haveOutputsEnded() const {
    for (std::size_t i = 0; i < pipeline_.outputCount(); ++i) {
      const runtime::OutputStage& output = pipeline_.output(i);
      if (!output.isFull() && !output.status().isFinal) return false;
    }
    return true;
  }

  /// One iteration of the main thread's loop.
  void poll() {
    hal::TimePoint wake = job_.clock->now() + kPollInterval;
    for (runtime::OutputStage* output : stepped_) {
      if (const auto next = output->step()) wake = std::min(wake, *next);
    }
    updateScreens();
    handleWindow();
    attend();
    handleSnapshots();
    report();
    if (stepped_.empty()) {
      job_.clock->sleepUntil(wake);
    } else {
      stepped_.front()->wait(wake);
    }
  }

  void retryOutputs() {
    for (std::size_t i = 0; i < pipeline_.outputCount(); ++i) pipeline_.output(i).retry();
  }

  void handleWindow() {
    if (!window_) return;
    handle(window_->takeRequests());
    pipeline_.paint().setPaused(tuning_.isPaused());
    const hal::TimePoint now = job_.clock->now();
    if (now - captioned_ < kCaptionInterval) return;
    captioned_ = now;
    const double rate = stepped_.front()->status().perSecond;
    const auto drawn = window_->update(rate, rate > kMinCaptionRate);
    // If there are other outputs, the window alone fails, at its next image.
    if (!drawn && pipeline_.outputCount() == 1) failure_ = drawn.error();
  }

  void handle(const LiveRequests& requests) {
    wantsToQuit_ = wantsToQuit_ || requests.quit;
    wantsSnapshot_ = wantsSnapshot_ || requests.snapshot;
    if (requests.tuned) controls_.setParameters(tuning_.parameters());
  }

  static bool isOnConsole(const std::string& target) {
    const auto kind = hal::outputKindOf(target);
    return kind && (*kind)->traits.isOnConsole;
  }

  /// Without a console of our own, displays are kept whichever is in front.
  void takeConsole() {
    auto taken = hal::VirtualTerminal::open(
        hal::kernelTerminals(), {.leave = hal::leaveConsole, .enter = hal::enterConsole});
    if (taken) {
      terminal_ = *std::move(taken);
    } else {
      spdlog::debug("no console of our own: {}", taken.error().message());
    }
  }

  /// Follows people: consoles that they switch to, keys, movements before the camera.
  void attend() {
    followConsole();
    handleKeys();
    const auto moved = pipeline_.capture().movedAt();
    if (std::exchange(movedAt_, moved) != moved || isPreparing()) noteActivity();
  }

  /// Whether there is a camera and no painting yet, which is not to come to a display that is off.
  bool isPreparing() {
    return movedAt_ && isPipelineMade_ && pipeline_.paint().status().painted == 0;
  }

  void followConsole() {
    const bool hasSwitched = terminal_ && terminal_->follow();
    const bool isInFront = !terminal_ || terminal_->isInFront();
    if (hasSwitched && isInFront) haveDisplaysChanged_ = true;  // those that could not be opened
    if (keys_) keys_->setPaused(!isInFront || isDisplayTaken_);
  }

  /// Whether another console or program has a display: keys are for that one.
  static bool isTaken(const runtime::OutputStage::Status& output) {
    if (output.isFailed) return output.failure && output.failure->kind == hal::ErrorKind::kBusy;
    return output.suspension && output.suspension->cause == hal::Suspension::Cause::kConsole;
  }

  void noteActivity() {
    if (!isPipelineMade_) return;
    for (std::size_t i = 0; i < pipeline_.outputCount(); ++i) pipeline_.output(i).noteActivity();
  }

  void handleKeys() {
    if (!keys_) return;
    const LiveKeys::Taken taken = keys_->take();
    if (taken.anyKey) noteActivity();
    handle(taken.requests);
    if (isPipelineMade_) pipeline_.paint().setPaused(tuning_.isPaused());
    if (!taken.problems.empty() || !taken.state.empty()) reporter_.interrupt();
    for (const hal::Error& each : taken.problems) spdlog::warn("keyboard {}", each.message());
    for (const std::string& each : taken.state) spdlog::info("{}", each);
  }

  void handleSnapshots() {
    if (const auto saved = saver_.takeResult()) reportSnapshot(*saved);
    // A second snapshot waits until the first one is on disk.
    if (saver_.isBusy() || saveSnapshot()) return;
    if (std::exchange(wantsSnapshot_, false)) controls_.requestSnapshot();
  }

  /// Begins to save a snapshot that was painted; returns false if there is none.
  bool saveSnapshot() {
    auto snapshot = controls_.takeSnapshot();
    if (!snapshot) return false;
    if (*snapshot) {
      saver_.save(**std::move(snapshot));
    } else {
      notify(snapshot->error().message(), false);
    }
    return true;
  }

  /// Saves and reports the painted snapshots, at the end.
  void finishSnapshots() {
    do {
      if (const auto saved = saver_.awaitResult()) reportSnapshot(*saved);
    } while (saveSnapshot());
  }

  void reportSnapshot(const hal::Result<std::filesystem::path>& saved) {
    notify(saved ? "saved " + saved->string() : saved.error().message(), saved.has_value());
  }

  void notify(const std::string& text, bool isGood) {
    if (window_) window_->notify(text);
    reporter_.interrupt();
    spdlog::log(isGood ? spdlog::level::info : spdlog::level::warn, "{}", text);
  }

  void report() {
    const hal::TimePoint now = job_.clock->now();
    if (now - reported_ < kReportInterval) return;
    reported_ = now;
    const runtime::RuntimeStatus status = pipeline_.status();
    reporter_.update(status, now);
    isDisplayTaken_ = std::ranges::any_of(status.outputs, isTaken);
    // If the first frames cannot be painted, no later one can.
    const bool isHopeless = status.painting.painted == 0 && status.painting.failures > 0;
    if (isHopeless) failure_ = status.painting.failure;
  }

  void finish() {
    const hal::Duration elapsed = job_.clock->now() - began_;
    stopThreads();
    finishSnapshots();
    screens_.finish();
    reportKeeping();
    reporter_.interrupt();
    const runtime::LedgerCounts ledger = pipeline_.ledger().counts();
    printSummary(ledger.summary(elapsed));
    if (!failure_ && !failures_.empty()) failure_ = failures_.front();
    if (failure_) throw hal::Failure(*failure_);
  }

  /// Idempotent. Does not return if a thread hangs.
  void stopThreads() {
    if (!threads_) return;
    const runtime::LiveThreads::Stopped stopped = threads_->stop(kStopPatience);
    if (!stopped.stuck.empty()) exitWithStuckThreads(stopped.stuck);
    failures_ = stopped.failures;
    for (runtime::OutputStage* output : stepped_) {
      if (auto finished = output->finish(); !finished) {
        failures_.push_back(std::move(finished.error()));
      }
    }
    threads_.reset();
  }

  void printSummary(const std::string& summary) const {
    writeText(stdout, fmt::format("{}: {}\n", summary, fmt::join(job_.outputs, ", ")));
  }

  /// Exits the process without destroying the objects, which the stuck threads still use. An error
  /// that is being handled is reported and decides the status. A painter that is still being
  /// created is no failure: a driver cannot be stopped while it compiles a program, and nothing has
  /// been painted that could be lost.
  [[noreturn]] void exitWithStuckThreads(const std::vector<std::string>& stuck) {
    reporter_.interrupt();
    terminal_.reset();
    const auto isOutput = [](const std::string& name) { return name.starts_with("output"); };
    if (!hasBegun_ && std::ranges::none_of(stuck, isOutput)) {
      for (std::size_t i = 0; i < pipeline_.outputCount(); ++i) pipeline_.output(i).discard();
    }
    auto status = ExitStatus::kSuccess;
    if (std::current_exception()) {
      status = reportCurrentException();
    } else {
      printSummary(pipeline_.ledger().counts().summary(job_.clock->now() - began_));
    }
    const bool isOnlyStarting =
        !hasBegun_ && stuck.size() == 1 && stuck.front() == runtime::LiveThreads::kPainter;
    if (!isOnlyStarting) {
      spdlog::error("{} did not end in time and was left behind", fmt::join(stuck, ", "));
      if (status == ExitStatus::kSuccess) status = ExitStatus::kInternal;
    }
    std::fflush(nullptr);
    std::_Exit(static_cast<int>(status));
  }

  const LiveJob& job_;
  std::unique_ptr<hal::VirtualTerminal> terminal_;  ///< outlives the displays, which it lets go of
  hal::CameraSupervisor supervisor_;
  runtime::LivePipeline pipeline_;
  hal::StreamFormat stream_;
  LiveTuning tuning_;
  LiveControls controls_;
  SnapshotSaver saver_;
  LiveReporter reporter_;
  Screens screens_;
  std::vector<std::unique_ptr<hal::Output>> opened_;  ///< until the pipeline owns them
  std::vector<runtime::OutputStage*> stepped_;  ///< outputs stepped on the main thread: the window
  std::optional<LiveWindow> window_;
  std::optional<LiveKeys> keys_;  ///< before the hot-plug monitor, which notifies it
  std::optional<runtime::LiveThreads> threads_;
  std::unique_ptr<hal::HotplugMonitor> hotplug_;  ///< notifies the supervisor
  std::atomic<bool> haveDisplaysChanged_ = false;
  std::atomic<bool> isPipelineMade_ = false;  ///< outputs and paint stage exist
  std::unique_ptr<StatusServer> server_;      ///< reads the pipeline's status

  hal::TimePoint waitingSince_;  ///< set before the status server starts
  hal::TimePoint began_;
  hal::TimePoint reported_;
  hal::TimePoint captioned_;
  hal::TimePoint screensUpdated_;
  std::string waitingCause_;
  std::optional<hal::TimePoint> movedAt_;
  std::vector<hal::Error> failures_;   ///< errors of outputs, at the end
  std::optional<hal::Error> failure_;  ///< the error that ended the painting
  bool hasBegun_ = false;              ///< frames flow to the outputs
  bool wantsToQuit_ = false;
  bool isDisplayTaken_ = false;
  bool wantsSnapshot_ = false;
};

}  // namespace

int runLive(const LiveJob& job) {
  LivePainting(job).run();
  return 0;
}

}  // namespace pleinair::app
