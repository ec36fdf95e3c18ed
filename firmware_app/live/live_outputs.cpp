#include "firmware_app/live/live_outputs.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include <spdlog/spdlog.h>

#include "firmware_app/cli/interrupt.h"
#include "firmware_app/config/requested_parts.h"
#include "firmware_app/live/runtime_rules.h"
#include "hal/outputs/registry.h"

namespace pleinair::app {
namespace {

using hal::orThrow;
using namespace std::chrono_literals;

/// A change of what is waited for is seen on screens after this.
constexpr hal::Duration kUpdateInterval = 50ms;
/// How long a screen may take to another mode before painting begins without it.
constexpr hal::Duration kModePatience = 3s;
constexpr hal::Duration kModePollInterval = 10ms;
/// The stream before there is a camera: the queues of screens are made for fast ones.
constexpr hal::Duration kShortestPeriod = 4ms;
constexpr hal::FrameSize kUsualSize{1280, 720};

/// Whether an output that cannot be opened may be there later.
bool mayCome(const hal::Error& error) {
  using enum hal::ErrorKind;
  return error.kind == kNotFound || error.kind == kDeviceLost || error.kind == kBusy;
}

}  // namespace

LiveOutputs::LiveOutputs(const LiveJob& job, runtime::LivePipeline& pipeline,
                         LiveReporter& reporter, runtime::FrameLog* log)
    : job_(job),
      pipeline_(pipeline),
      reporter_(reporter),
      log_(log),
      stream_({.frame = {.pixelFormat = hal::PixelFormat::kRgb8,
                         .size = job.request.size.value_or(kUsualSize),
                         .encoding = {}},
               .framePeriod = job.request.framePeriod,
               .frameCount = {}}),
      screens_(job.selector->choice(), job.state, *job.clock) {
  for (const std::string& name : job.outputs) {
    orThrow(checkOutputFolder(name));  // now, because the camera may come much later
    opened_.push_back(orThrow(job.openOutput(name)));
  }
  isStarted_.resize(opened_.size());
}

bool LiveOutputs::isScreen(const std::string& target) const {
  return job_.showsWaiting && orThrow(hal::outputKindOf(target))->traits.showsWaiting;
}

bool LiveOutputs::isOnConsole(const std::string& target) const {
  return orThrow(hal::outputKindOf(target))->traits.isOnConsole;
}

void LiveOutputs::startScreens() {
  for (std::size_t i = 0; i < opened_.size(); ++i) {
    if (isScreen(job_.outputs[i]) && isOnConsole(job_.outputs[i])) startOutput(i);
  }
  if (screens_.isEmpty()) return;
  update({.camera = pipeline_.capture().status()});
  screens_.showFirst(*job_.clock);
}

void LiveOutputs::startWindows() {
  for (std::size_t i = 0; i < opened_.size(); ++i) {
    if (isScreen(job_.outputs[i]) && !isStarted_[i]) startOutput(i);
  }
}

void LiveOutputs::stepWindows() {
  for (runtime::OutputStage* each : stepped_) each->step();
}

void LiveOutputs::start(const hal::StreamFormat& stream) {
  stream_ = stream;
  isStreamKnown_ = true;
  reconfigureScreens();
  // That something else is waited for now is said before it takes all of the processor.
  update({.camera = pipeline_.capture().status()});
  for (std::size_t i = 0; i < opened_.size(); ++i) {
    if (!isStarted_[i]) startOutput(i);
  }
}

/// Has the screens, which were opened without knowing the stream, take it.
void LiveOutputs::reconfigureScreens() {
  const std::vector<runtime::OutputStage*> stages = screens_.stages();
  for (runtime::OutputStage* each : stages) each->reconfigure(request());
  const hal::TimePoint deadline = job_.clock->now() + kModePatience;
  const auto isDone = [](const runtime::OutputStage* each) { return each->isReconfigured(); };
  for (;;) {
    stepWindows();
    if (std::ranges::all_of(stages, isDone) || job_.clock->now() >= deadline ||
        Interrupt::received() != 0) {
      return;
    }
    job_.clock->sleepUntil(job_.clock->now() + kModePollInterval);
  }
}

hal::FrameSize LiveOutputs::pictureSize() const {
  return job_.options.size.value_or(stream_.frame.size);
}

hal::OutputRequest LiveOutputs::request() const {
  return {.size = pictureSize(), .framePeriod = stream_.framePeriod};
}

void LiveOutputs::startOutput(std::size_t index) {
  std::unique_ptr<hal::Output>& opened = opened_.at(index);
  const std::string& target = job_.outputs.at(index);
  const hal::OutputKind& kind = *orThrow(hal::outputKindOf(target));
  hal::StreamFormat stream = stream_;
  if (!isStreamKnown_) stream.framePeriod = kShortestPeriod;
  runtime::OutputStageOptions options = outputRules(target, job_.openOutput, job_.runtime, stream);
  options.request = request();
  // The page for people shows that of the first.
  options.keepsLastFrame = isScreen(target) || (job_.servesPictures && index == 0);
  options.latency = hal::fromMilliseconds(job_.runtime.latencyMs);
  options.limit = job_.options.frames;
  options.log = log_;
  options.logNumber = index;
  hal::Result<hal::OutputFormat> started = opened->start(options.request);
  if (!started && job_.waitsForOutputs && kind.traits.reopens && mayCome(started.error())) {
    spdlog::warn("waiting for an output: {}", started.error().message());
    options.absence = std::move(started.error());
    opened.reset();
    started = hal::OutputFormat{
        .frame = {.pixelFormat = hal::PixelFormat::kRgba8, .size = options.request.size},
        .refresh = std::nullopt};
  }
  const hal::OutputFormat format = orThrow(std::move(started));
  auto* const window = dynamic_cast<hal::Window*>(opened.get());
  runtime::OutputStage& output = pipeline_.addOutput(std::move(opened), format, std::move(options));
  if (window != nullptr) {
    window_ = window;
    windowStage_ = &output;
    windowDisplay_ =
        window->lender() == nullptr ? nullptr : window->lender()->eglDisplay().value_or(nullptr);
  }
  if (kind.traits.isOnMainThread) stepped_.push_back(&output);
  if (isOnConsole(target)) displays_.push_back(&output);
  if (isScreen(target)) screens_.add(output, isOnConsole(target), kind.traits.isOnMainThread);
  isStarted_[index] = true;
}

void* LiveOutputs::windowDisplay() const {
  const bool isUsable = windowStage_ != nullptr && !windowStage_->status().isFailed;
  return isUsable ? windowDisplay_ : nullptr;
}

bool LiveOutputs::isUpdateDue() const {
  if (haveDisplaysChanged_) return true;
  return !screens_.isEmpty() && job_.clock->now() - updated_ >= kUpdateInterval;
}

void LiveOutputs::update(const LiveProgress& progress) {
  if (haveDisplaysChanged_.exchange(false)) {
    for (std::size_t i = 0; i < pipeline_.outputCount(); ++i) pipeline_.output(i).retry();
  }
  if (screens_.isEmpty()) return;
  updated_ = job_.clock->now();
  screens_.update(progress);
  reportKeeping();
  reportScanOut();
}

void LiveOutputs::finish() {
  screens_.finish();
  reportKeeping();
}

void LiveOutputs::reportKeeping() {
  const std::optional<hal::Error> failure = screens_.takeFailure();
  if (!failure) return;
  // A full disk fails each time.
  const std::string before = std::exchange(keepingProblem_, failure->message());
  if (keepingProblem_ == before) return;
  reporter_.interrupt();
  spdlog::warn("the last painting: {}", keepingProblem_);
}

std::vector<OutputProgress> LiveOutputs::progress() const {
  const std::vector<runtime::OutputStage*> screens = screens_.stages();
  std::vector<OutputProgress> progress;
  for (std::size_t i = 0; i < pipeline_.outputCount(); ++i) {
    const runtime::OutputStage& output = pipeline_.output(i);
    const bool isScreen = std::ranges::find(screens, &output) != screens.end();
    progress.push_back(progressOf(output.status(), isScreen));
  }
  return progress;
}

/// How pictures reach the memory of displays, once it is found out and when it changes.
void LiveOutputs::reportScanOut() {
  using Path = runtime::ScanOut::Path;
  for (const runtime::OutputStage* each : screens_.stages()) {
    const runtime::ScanOut now = each->status().scanOut;
    runtime::ScanOut& told = scanOut_[each->name()];
    if (now.path == told.path && now.reason == told.reason) continue;
    told = now;
    reporter_.interrupt();
    if (now.path == Path::kDirect) {
      spdlog::info("{}: the GPU draws straight into it, {} ({:.0f} ms)", each->name(), now.reason,
                   hal::toMilliseconds(now.took));
    } else {
      spdlog::info("{}: pictures are copied: {}", each->name(), now.reason);
    }
  }
}

bool LiveOutputs::haveEnded() const {
  for (std::size_t i = 0; i < pipeline_.outputCount(); ++i) {
    const runtime::OutputStage& output = pipeline_.output(i);
    if (!output.isFull() && !output.status().isFinal) return false;
  }
  return true;
}

}  // namespace pleinair::app
