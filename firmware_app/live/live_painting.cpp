#include "firmware_app/live/live_painting.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "firmware_app/cli/compile_notice.h"
#include "firmware_app/cli/exit_status.h"
#include "firmware_app/cli/interrupt.h"
#include "firmware_app/cli/reload_signal.h"
#include "firmware_app/cli/stale_parts.h"
#include "firmware_app/cli/standard_streams.h"
#include "firmware_app/config/camera_selection.h"
#include "firmware_app/live/interaction/live_input.h"
#include "firmware_app/live/live_controls.h"
#include "firmware_app/live/live_outputs.h"
#include "firmware_app/live/live_painter.h"
#include "firmware_app/live/live_snapshots.h"
#include "firmware_app/live/procedure_follower.h"
#include "firmware_app/live/runtime_rules.h"
#include "firmware_app/live/status/frame_log_file.h"
#include "firmware_app/live/status/live_reporter.h"
#include "firmware_app/live/status/live_status.h"
#include "firmware_app/live/status/machine_health.h"
#include "firmware_app/live/status/service_reporter.h"
#include "firmware_app/live/status/steady_painting.h"
#include "firmware_app/scene/scene_warnings.h"
#include "hal/supervisor/camera_supervisor.h"
#include "hal/supervisor/hotplug_monitor.h"
#include "pipeline/engine/painter.h"
#include "pipeline/runtime/live_pipeline.h"
#include "pipeline/runtime/live_threads.h"
#include "pipeline/runtime/status/status_text.h"

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;

/// How often the main thread polls keys, signals and the state of the pipeline.
constexpr hal::Duration kPollInterval = 10ms;
constexpr hal::Duration kReportInterval = 100ms;
/// A camera that comes sooner is not waited for in a window: it opens with the camera's size.
constexpr hal::Duration kWindowPatience = 1s;
/// Part of the two seconds that ending may take; the rest is for the exit itself.
constexpr hal::Duration kStopPatience = 1500ms;

/// The life of a live pipeline, from waiting for its camera to its closing line, with its status
/// server and reports. Main thread.
class LivePainting {
 public:
  explicit LivePainting(const LiveJob& job)
      : job_(job),
        controls_({job.options.style, startParameters(job.options)}),
        reporter_(qualityNames()),
        input_(job, controls_, reporter_),
        supervisor_(*job.selector, *job.clock, {}, job.cameraRequest()),
        pipeline_(supervisor_, *job.clock),
        outputs_(job, pipeline_, reporter_, openFrameLog()),
        snapshots_(job.snapshots, controls_, input_, notifier()),
        health_(job.health, heatRules(job.runtime)),
        status_(job, pipeline_, controls_, health_),
        steady_(job.steadyMark) {
    if (job.procedure != nullptr) procedure_.emplace(job, controls_, input_, notifier());
    if (!job.serviceManager) return;
    service_.emplace(*job.serviceManager);
    outputs_.renewWaitingAfter(service_->renewal());
  }
  ~LivePainting() { stopThreads(); }
  LivePainting(const LivePainting&) = delete;
  LivePainting& operator=(const LivePainting&) = delete;

  void run() {
    try {
      paintUntilEnd();
      finish();
    } catch (...) {
      // Threads end here, where the error is known that decides the exit status should one hang.
      stopThreads();
      finishProcedure();
      writeFrameLog();
      throw;
    }
  }

 private:
  using RecordEnd = LiveProcedure::RecordEnd;

  void paintUntilEnd() {
    began_ = job_.clock->now();
    outputs_.startScreens();  // before the camera, which the camera thread opens
    threads_.emplace(pipeline_);
    for (runtime::OutputStage* each : outputs_.screens()) threads_->startOutput(*each);
    std::string why;
    hotplug_ = watchDevices([this](const hal::DeviceEvent& event) { devicesChanged(event); }, why);
    if (!hotplug_) spdlog::debug("no hot-plug events: {}", why);
    status_.begin(began_);
    if (job_.serveStatus) server_ = job_.serveStatus(status_.pages());
    if (awaitStream()) {
      startOutputs();
      if (awaitPainter()) paint();
    }
  }

  /// Any thread.
  void devicesChanged(const hal::DeviceEvent& event) {
    if (event.subsystem == "drm") {
      outputs_.devicesChanged();
    } else if (event.subsystem == "input") {
      input_.devicesChanged();
    } else {
      supervisor_.devicesChanged();
    }
  }

  /// Null where the job wants none.
  runtime::FrameLog* openFrameLog() {
    if (job_.frameLog.empty()) return nullptr;
    return &frameLog_.emplace(job_.frameLog, job_.outputs).log();
  }

  void writeFrameLog() {
    if (!frameLog_) return;
    const auto written = frameLog_->update();
    if (!written) notify("the log of frames: " + written.error().message(), false);
  }

  /// Null until it is complete. Any thread.
  runtime::LivePipeline* pipeline() const { return status_.pipeline(); }

  bool isToEnd() const { return Interrupt::received() != 0 || input_.wantsToQuit() || startsAnew_; }

  /// Shows in windows what is waited for. Returns false where there is nothing left to show it in.
  bool stepWindows() {
    if (outputs_.stepped().empty()) return true;
    outputs_.stepWindows();
    if (hal::Window* window = outputs_.window()) input_.openWindow(*window);
    const auto drawn = input_.updateWindow(pipeline(), 0.0);
    if (drawn || pipeline_.outputCount() > 1) return true;
    failure_ = drawn.error();
    return false;
  }

  /// Follows the people and what the screens wait for.
  void attend() {
    if (input_.poll(pipeline(), pipeline_.capture().movedAt())) outputs_.devicesChanged();
    input_.updateDisplays(outputs_.displays());
    followStyle();
    if (job_.reload && ReloadSignal::take()) reload();
    if (service_ && service_->isDue(job_.clock->now())) reportToService();
    followHeat();
    followSite();
    followProcedure();
    if (!outputs_.isUpdateDue()) return;
    const auto painting = progress();
    outputs_.update({.camera = pipeline_.capture().status(),
                     .hasBegun = hasBegun_,
                     .hasPainter = painting.hasPainter,
                     .isRenewing = painting.isRenewing,
                     .painted = painting.painted});
  }

  /// A hot machine that slowed itself down would lose frames.
  void followHeat() {
    const auto advice = health_.update(progress().quality, job_.clock->now());
    if (!advice) return;
    if (pipeline() != nullptr) pipeline_.paint().limitQuality(advice->best);
    if (!advice->notice.empty()) notify(advice->notice, advice->isGood);
  }

  /// A service manager starts the program again, which then reads what has come.
  void followSite() {
    if (!job_.isToStartAnew || startsAnew_ || !job_.isToStartAnew()) return;
    startsAnew_ = true;
    notify("there is another site.toml: starting anew", true);
  }

  /// Another style is another painter, which compiles its shaders first.
  void followStyle() {
    if (pipeline() == nullptr) return;
    const std::string style = controls_.parameters()->style;
    if (std::exchange(style_, style) == style) return;
    pipeline_.paint().renew();
    notify("preparing to paint in the style " + style, true);
  }

  runtime::PaintStage::Progress progress() {
    return pipeline() == nullptr ? runtime::PaintStage::Progress() : pipeline_.paint().progress();
  }

  /// A camera may come back with another rate.
  void followRate(const runtime::CaptureStage::Status& camera) {
    if (pipeline() == nullptr || !camera.format) return;
    if (camera.format->framePeriod == stream_.framePeriod) return;
    stream_.framePeriod = camera.format->framePeriod;
    pipeline_.paint().setFramePeriod(paintRules(job_.runtime, stream_).framePeriod);
  }

  void reportToService() {
    const auto painting = progress();
    const runtime::RuntimeStatus status = status_.now();
    const bool isStreaming = status.camera.state == hal::CameraState::kStreaming;
    const std::vector<OutputProgress> shown = outputs_.progress();
    steady_.update(shown, job_.clock->now());
    service_->update({.outputs = shown,
                      .expectsPaintings = hasBegun_ && isStreaming && painting.hasPainter,
                      .isTriggered = status.camera.format && status.camera.format->isTriggered,
                      .arrived = status.camera.arrived,
                      .painted = painting.painted},
                     hasBegun_ ? runtime::statusLine(status, qualityNames()) : startingText(status),
                     job_.clock->now());
  }

  static std::string startingText(const runtime::RuntimeStatus& status) {
    return status.camera.format ? "preparing to paint" : status.camera.reason;
  }

  /// Applies the parameters of the configuration as it is now; if it is wrong, the last ones stay.
  void reload() {
    if (service_) service_->reloading(job_.clock->now());
    const ReloadOutcome next = outcomeOf(job_.reload);
    if (next.painting) {
      input_.setParameters({next.painting->style, startParameters(*next.painting)});
    }
    notify(next.notice, next.painting.has_value());
    if (service_) service_->reloaded(next.painting ? "" : next.notice);
  }

  /// Returns false if a signal ended the wait.
  bool awaitStream() {
    for (;;) {
      attend();
      if (isToEnd() || !stepWindows()) return false;
      if (job_.clock->now() - began_ >= kWindowPatience) outputs_.startWindows();
      const runtime::CaptureStage::Status camera = pipeline_.capture().status();
      if (camera.format) {
        stream_ = *camera.format;
        return true;
      }
      const bool gaveUp = camera.hasEnded || (camera.cause && !job_.waitsForCamera);
      if (gaveUp) throw hal::Failure(camera.cause.value_or(noFrames()));
      if (camera.cause) reportWaiting(camera.cause->message());
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

  void startOutputs() {
    for (const std::string& notice : job_.scene.notices) spdlog::warn("{}", notice);
    for (const auto& warning : {assumedCameraWarning(job_.scene, stream_.frame.size),
                                blackViewWarning(job_.scene, job_.options.view)}) {
      if (warning) spdlog::warn("{}", *warning);
    }
    outputs_.start(stream_);
    for (const std::string& target : job_.outputs) {
      if (!orThrow(hal::outputKindOf(target))->traits.writesFiles) continue;
      for (const std::string& notice : stalePartNotices(target)) spdlog::warn("{}", notice);
    }
    if (hal::Window* window = outputs_.window()) input_.openWindow(*window);
    if (procedure_) procedure_->makeOverlay(outputs_.pictureSize());
    style_ = controls_.parameters()->style;
    pipeline_.makePaintStage([this] { return makePainter(); }, paintRules(job_.runtime, stream_));
    threads_->startPainter();
    status_.setComplete();
  }

  std::unique_ptr<runtime::FramePainter> makePainter() {
    const std::shared_ptr<const LiveParameters> start = controls_.parameters();
    const PainterOptions options{.pictureSize = outputs_.pictureSize(),
                                 .scene = job_.scene,
                                 .style = start->style,
                                 .tracksTags = job_.tracksTags(),
                                 .isCameraMounted = job_.options.isCameraMounted,
                                 .shaderDirectory = job_.options.shaderDirectory,
                                 .passTiming = gpu::PassTiming::kSampled,
                                 .expectedFormat = stream_.frame,
                                 .qualityLevels = job_.runtime.quality != qualityNames().front(),
                                 .overlay = job_.procedure != nullptr,
                                 .machine = job_.machine,
                                 .doubtfulTags = procedure_ ? procedure_->doubtfulTags() : nullptr,
                                 .isCancelled = [this] { return isStopping_ || isSignalled_(); },
                                 .windows = outputs_.windowDisplay()};
    return std::make_unique<LivePainter>(options, controls_, start,
                                         procedure_ ? procedure_->machine() : MachinePlace());
  }

  bool awaitPainter() {
    while (!isToEnd()) {
      if (threads_->isPainterReady()) return true;
      attend();
      if (!stepWindows()) return false;
      job_.clock->sleepUntil(job_.clock->now() + kPollInterval);
    }
    return false;
  }

  void paint() {
    hasBegun_ = true;
    const std::vector<runtime::OutputStage*>& stepped = outputs_.stepped();
    threads_->startOutputs({stepped.begin(), stepped.end()});
    began_ = job_.clock->now();
    while (!isOver()) poll();
  }

  bool isOver() const {
    return isToEnd() || failure_ || outputs_.haveEnded() || pipeline_.isDrained();
  }

  /// One iteration of the main thread's loop.
  void poll() {
    hal::TimePoint wake = job_.clock->now() + kPollInterval;
    const std::vector<runtime::OutputStage*>& stepped = outputs_.stepped();
    for (runtime::OutputStage* output : stepped) {
      if (const auto next = output->step()) wake = std::min(wake, *next);
    }
    updateWindow();
    attend();
    snapshots_.update();
    if (const auto text = input_.takeCommandLine()) notify(*text, true);
    report();
    if (stepped.empty()) {
      job_.clock->sleepUntil(wake);
    } else {
      stepped.front()->wait(wake);
    }
  }

  void updateWindow() {
    if (outputs_.stepped().empty()) return;
    const double rate = outputs_.stepped().front()->status().perSecond;
    const auto drawn = input_.updateWindow(&pipeline_, rate);
    // If there are other outputs, the window alone fails, at its next image.
    if (!drawn && pipeline_.outputCount() == 1) failure_ = drawn.error();
  }

  /// Steps that inputs have made, before there is a painting, too.
  void followProcedure() {
    if (!procedure_) return;
    procedure_->update(hasBegun_);
    const auto step = procedure_->takeStep();
    if (!step) return;
    reporter_.interrupt();
    spdlog::info("{}", *step);
  }

  /// The last answers are on the disk before the program ends. Idempotent. Does not return if the
  /// record's thread hangs.
  void finishProcedure() {
    if (awaitRecord() != RecordEnd::kWritten) exitWithStuckThreads({});
  }

  RecordEnd awaitRecord() {
    if (!procedure_) return RecordEnd::kWritten;
    return procedure_->end(stopsBy_.value_or(std::chrono::steady_clock::now() + kStopPatience));
  }

  void notify(const std::string& text, bool isGood) {
    input_.notify(text);
    reporter_.interrupt();
    spdlog::log(isGood ? spdlog::level::info : spdlog::level::warn, "{}", text);
  }

  std::function<void(const std::string&, bool)> notifier() {
    return [this](const std::string& text, bool isGood) { notify(text, isGood); };
  }

  void report() {
    const hal::TimePoint now = job_.clock->now();
    if (now - reported_ < kReportInterval) return;
    reported_ = now;
    const runtime::RuntimeStatus status = pipeline_.status();
    followRate(status.camera);
    reporter_.update(status, now);
    writeFrameLog();
    if (runtime::takeDemotion()) {
      notify(
          "a camera's or a display's thread was too slow for its real-time priority, and goes on "
          "without",
          false);
    }
    input_.noteOutputs(status.outputs);
    // If the first frames cannot be painted, no later one can.
    const bool isHopeless = status.painting.painted == 0 && status.painting.failures > 0;
    if (isHopeless) failure_ = status.painting.failure;
  }

  void finish() {
    const hal::Duration elapsed = job_.clock->now() - began_;
    stopThreads();
    snapshots_.finish();
    outputs_.finish();
    writeFrameLog();
    if (!failure_ && !failures_.empty()) failure_ = failures_.front();
    if (!failure_) finishProcedure();  // else where the failure is handled
    reporter_.interrupt();
    const runtime::LedgerCounts ledger = pipeline_.ledger().counts();
    printSummary(ledger.summary(elapsed));
    if (failure_) throw hal::Failure(*failure_);
  }

  /// Idempotent. Does not return if a thread hangs.
  void stopThreads() {
    if (!threads_) return;
    if (service_) service_->stopping();
    isStopping_ = true;
    stopsBy_ = std::chrono::steady_clock::now() + kStopPatience;
    const runtime::LiveThreads::Stopped stopped = threads_->stop(kStopPatience);
    if (!stopped.stuck.empty()) exitWithStuckThreads(stopped.stuck);
    failures_ = stopped.failures;
    for (runtime::OutputStage* output : outputs_.stepped()) {
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
  /// been painted that could be lost. Nor is a procedure that is being read again.
  [[noreturn]] void exitWithStuckThreads(std::vector<std::string> stuck) {
    reporter_.interrupt();
    input_.releaseConsole();
    const RecordEnd record = awaitRecord();
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
    const bool isHarmless = record != RecordEnd::kIsWriting && (stuck.empty() || isOnlyStarting);
    if (record != RecordEnd::kWritten) stuck.emplace_back("record");
    if (!isHarmless) {
      spdlog::error("{} did not end in time and was left behind", fmt::join(stuck, ", "));
      if (status == ExitStatus::kSuccess) status = ExitStatus::kInternal;
    }
    writeFrameLog();  // it tells of what got stuck
    std::fflush(nullptr);
    std::_Exit(static_cast<int>(status));
  }

  const LiveJob& job_;
  LiveControls controls_;
  LiveReporter reporter_;
  LiveInput input_;  ///< its console outlives the displays, which it lets go of
  std::optional<FrameLogFile> frameLog_;
  hal::CameraSupervisor supervisor_;
  runtime::LivePipeline pipeline_;
  hal::StreamFormat stream_;  ///< the camera's
  LiveOutputs outputs_;
  LiveSnapshots snapshots_;
  MachineHealth health_;
  LiveStatus status_;
  std::optional<ProcedureFollower> procedure_;
  std::optional<runtime::LiveThreads> threads_;
  std::unique_ptr<hal::HotplugMonitor> hotplug_;  ///< notifies supervisor, outputs and input
  std::unique_ptr<StatusServer> server_;          ///< reads the pipeline's status
  std::optional<ServiceReporter> service_;        ///< unset where no service manager listens
  SteadyMark steady_;

  hal::TimePoint began_;
  hal::TimePoint reported_;
  std::string waitingCause_;
  std::optional<std::chrono::steady_clock::time_point> stopsBy_;
  std::string style_;  ///< of the painter that was made, or is being made
  const std::function<bool()> isSignalled_ = cancelledBySignal();
  std::atomic<bool> isStopping_ = false;
  std::vector<hal::Error> failures_;   ///< errors of outputs, at the end
  std::optional<hal::Error> failure_;  ///< the error that ended the painting
  bool startsAnew_ = false;            ///< for another site file
  bool hasBegun_ = false;              ///< frames flow to the outputs
};

}  // namespace

int runLive(const LiveJob& job) {
  LivePainting(job).run();
  return 0;
}

}  // namespace pleinair::app
