#include "firmware_app/live/live_input.h"

#include <algorithm>
#include <string>
#include <utility>

#include <spdlog/spdlog.h>

#include "hal/outputs/display/display_output.h"
#include "hal/outputs/registry.h"
#include "pipeline/styles/registry.h"

namespace pleinair::app {
namespace {

constexpr hal::Duration kCaptionInterval = std::chrono::milliseconds(33);
/// From this many frames a second on, the next image draws the caption soon enough.
constexpr double kMinCaptionRate = 8.0;

LiveTuning tuningOf(const PaintingOptions& options) {
  const styles::StyleKind& info = styles::styleKind(options.style);
  std::vector<LiveLook> looks;
  for (const styles::Look& look : info.looks) {
    looks.push_back({std::string(look.name), info.parametersOf(look.name)});
  }
  return {options.style, startParameters(options), debugViewsOf(options.style), std::move(looks)};
}

bool isOnConsole(const std::string& target) {
  const auto kind = hal::outputKindOf(target);
  return kind && (*kind)->traits.isOnConsole;
}

bool isTaken(const runtime::OutputStage::Status& output) {
  if (output.isFailed) return output.failure && output.failure->kind == hal::ErrorKind::kBusy;
  return output.suspension && output.suspension->cause == hal::Suspension::Cause::kConsole;
}

}  // namespace

LiveInput::LiveInput(const LiveJob& job, LiveControls& controls, LiveReporter& reporter)
    : job_(job), controls_(controls), reporter_(reporter), tuning_(tuningOf(job.options)) {
  if (std::ranges::any_of(job.outputs, isOnConsole)) takeConsole();
  if (job.keyboards) {
    keys_.emplace(*job.keyboards, hal::kernelKeyboards(), tuning_, *job.clock);
  }
}

LiveInput::~LiveInput() = default;

/// Without a console of our own, displays are kept whichever is in front.
void LiveInput::takeConsole() {
  auto taken = hal::VirtualTerminal::open(hal::kernelTerminals(),
                                          {.leave = hal::leaveConsole, .enter = hal::enterConsole});
  if (taken) {
    terminal_ = *std::move(taken);
  } else {
    spdlog::debug("no console of our own: {}", taken.error().message());
  }
}

void LiveInput::devicesChanged() {
  if (keys_) keys_->devicesChanged();
}

bool LiveInput::poll(runtime::LivePipeline* pipeline, std::optional<hal::TimePoint> movedAt) {
  const bool hasReturned = followConsole();
  Presence::Seen seen{.anyKey = handleKeys(pipeline), .movedAt = movedAt};
  if (pipeline != nullptr) seen.painted = pipeline->paint().status().painted;
  if (presence_.update(seen) && pipeline != nullptr) {
    for (std::size_t i = 0; i < pipeline->outputCount(); ++i) pipeline->output(i).noteActivity();
  }
  return hasReturned;
}

bool LiveInput::followConsole() {
  const bool hasSwitched = terminal_ && terminal_->follow();
  const bool isInFront = !terminal_ || terminal_->isInFront();
  if (keys_) keys_->setPaused(!isInFront || isDisplayTaken_);
  return hasSwitched && isInFront;
}

/// Returns whether a key was pressed, of any meaning.
bool LiveInput::handleKeys(runtime::LivePipeline* pipeline) {
  if (!keys_) return false;
  const LiveKeys::Taken taken = keys_->take();
  handle(taken.requests);
  if (pipeline != nullptr) pipeline->paint().setPaused(tuning_.isPaused());
  if (!taken.problems.empty() || !taken.state.empty()) reporter_.interrupt();
  for (const hal::Error& each : taken.problems) spdlog::warn("keyboard {}", each.message());
  for (const std::string& each : taken.state) spdlog::info("{}", each);
  return taken.anyKey;
}

hal::Result<void> LiveInput::updateWindow(runtime::LivePipeline& pipeline, double framesPerSecond) {
  if (!window_) return {};
  handle(window_->takeRequests());
  pipeline.paint().setPaused(tuning_.isPaused());
  const hal::TimePoint now = job_.clock->now();
  if (now - captioned_ < kCaptionInterval) return {};
  captioned_ = now;
  return window_->update(framesPerSecond, framesPerSecond > kMinCaptionRate);
}

void LiveInput::handle(const LiveRequests& requests) {
  wantsToQuit_ = wantsToQuit_ || requests.quit;
  wantsSnapshot_ = wantsSnapshot_ || requests.snapshot;
  if (requests.tuned) controls_.setParameters(tuning_.parameters());
}

bool LiveInput::takeSnapshotRequest() {
  return std::exchange(wantsSnapshot_, false);
}

void LiveInput::notify(const std::string& text) {
  if (window_) window_->notify(text);
}

void LiveInput::noteOutputs(const std::vector<runtime::OutputStage::Status>& outputs) {
  isDisplayTaken_ = std::ranges::any_of(outputs, isTaken);
}

}  // namespace pleinair::app
