#include "firmware_app/live/interaction/live_input.h"

#include <algorithm>
#include <string>
#include <utility>

#include <spdlog/spdlog.h>

#include "firmware_app/cli/shell_text.h"
#include "firmware_app/repair_station/step_text.h"
#include "hal/outputs/display/display_output.h"
#include "hal/outputs/registry.h"
#include "pipeline/styles/registry.h"

namespace pleinair::app {
namespace {

constexpr hal::Duration kCaptionInterval = std::chrono::milliseconds(33);
/// From this many frames a second on, the next image draws the caption soon enough.
constexpr double kMinCaptionRate = 8.0;
/// So long after a key, somebody waits for what it does: a snapshot takes a while to be saved.
constexpr hal::Duration kAtTheKeys = std::chrono::seconds(30);

LiveStyle liveStyle(const styles::StyleKind& kind, PaintParameters start) {
  LiveStyle style{.name = std::string(kind.name),
                  .start = std::move(start),
                  .views = debugViewsOf(kind.name),
                  .looks = {}};
  for (const styles::Look& look : kind.looks) {
    style.looks.push_back({std::string(look.name), kind.parametersOf(look.name)});
  }
  return style;
}

/// All styles, with the parameters that the configuration has for each.
LiveTuning tuningOf(const LiveJob& job) {
  std::vector<LiveStyle> styles;
  std::size_t first = 0;
  for (const styles::StyleKind* kind : styles::styleKinds()) {
    if (kind->name == job.options.style) {
      first = styles.size();
      styles.push_back(liveStyle(*kind, startParameters(job.options)));
      continue;
    }
    const auto configured = job.otherStyles.find(std::string(kind->name));
    styles.push_back(liveStyle(
        *kind, {.style = configured == job.otherStyles.end() ? kind->defaults : configured->second,
                .view = {}}));
  }
  return LiveTuning(std::move(styles), first);
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
    : job_(job),
      controls_(controls),
      reporter_(reporter),
      tuning_(tuningOf(job)),
      displayCaption_(tuning_, *job.clock) {
  if (job.procedure != nullptr) {
    tuning_.setKeyFilter(
        [procedure = job.procedure](const hal::KeyPressed& key) { return procedure->press(key); },
        keyHelp(job.procedure->language()));
    steps_.emplace(job.inputs, hal::kernelKeyboards(), *job.procedure, job.commands, *job.clock);
  }
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
  if (steps_) steps_->devicesChanged();
}

bool LiveInput::poll(runtime::LivePipeline* pipeline, std::optional<hal::TimePoint> movedAt) {
  const bool hasReturned = followConsole();
  const bool hasStepped = handleSteps();
  Presence::Seen seen{.anyKey = handleKeys(pipeline) || hasStepped, .movedAt = movedAt};
  if (pipeline != nullptr) seen.painted = pipeline->paint().progress().painted;
  if (presence_.update(seen) && pipeline != nullptr) {
    for (std::size_t i = 0; i < pipeline->outputCount(); ++i) pipeline->output(i).noteActivity();
  }
  return hasReturned;
}

bool LiveInput::followConsole() {
  const bool hasSwitched = terminal_ && terminal_->follow();
  const bool isInFront = !terminal_ || terminal_->isInFront();
  if (keys_) keys_->setPaused(!isInFront || isDisplayTaken_);
  if (steps_) steps_->setPaused(!isInFront || isDisplayTaken_);
  return hasSwitched && isInFront;
}

/// Returns whether a key was pressed, of any meaning.
bool LiveInput::handleKeys(runtime::LivePipeline* pipeline) {
  if (!keys_) return false;
  const LiveKeys::Taken taken = keys_->take();
  handle(taken.requests);
  if (taken.anyKey) keyPressed_ = job_.clock->now();
  if (taken.requests.tuned) {
    displayCaption_.keyPressed();
  } else if (taken.anyKey) {
    displayCaption_.notify("h: help");
  }
  if (pipeline != nullptr) pipeline->paint().setPaused(tuning_.isPaused());
  if (!taken.problems.empty() || !taken.state.empty()) reporter_.interrupt();
  for (const hal::Error& each : taken.problems) spdlog::warn("keyboard {}", each.message());
  for (const std::string& each : taken.state) spdlog::info("{}", each);
  return taken.anyKey;
}

/// Returns whether somebody used an input.
bool LiveInput::handleSteps() {
  if (!steps_) return false;
  const StepInputs::Taken taken = steps_->poll();
  if (!taken.problems.empty() || !taken.notices.empty()) reporter_.interrupt();
  for (const hal::Error& each : taken.problems) spdlog::warn("input {}", each.message());
  for (const std::string& each : taken.notices) {
    notify(each);
    spdlog::info("{}", each);
  }
  if (taken.togglesRaw) {
    tuning_.toggleCamera();
    controls_.setParameters({tuning_.styleName(), tuning_.parameters()});
  }
  return taken.any;
}

void LiveInput::see(const SeenTags& tags) {
  if (steps_) steps_->see(tags.tags(), tags.captured);
}

hal::Result<void> LiveInput::updateWindow(runtime::LivePipeline* pipeline, double framesPerSecond) {
  if (!window_) return {};
  handle(window_->takeRequests());
  if (pipeline != nullptr) pipeline->paint().setPaused(tuning_.isPaused());
  const hal::TimePoint now = job_.clock->now();
  if (now - captioned_ < kCaptionInterval) return {};
  captioned_ = now;
  // Until there is a painting, which has it in its overlay.
  const bool hasStep = job_.procedure != nullptr && !controls_.overlay();
  window_->pin(pinnedText(hasStep ? job_.procedure->text() : std::string()));
  return window_->update(framesPerSecond, framesPerSecond > kMinCaptionRate);
}

std::string LiveInput::pinnedText(const std::string& step) const {
  std::string text = step;
  const std::string notice = job_.notice ? job_.notice() : std::string();
  for (const std::string& each : {job_.standingText, notice}) {
    if (!each.empty()) text += (text.empty() ? "" : "\n\n") + each;
  }
  return text;
}

void LiveInput::updateDisplays(const std::vector<runtime::OutputStage*>& displays) {
  const hal::TimePoint now = job_.clock->now();
  if (displays.empty() || now - displaysCaptioned_ < kCaptionInterval) return;
  displaysCaptioned_ = now;
  displayCaption_.pin(pinnedText(job_.procedure != nullptr ? job_.procedure->text() : ""));
  displayCaptions_.update(displays, displayCaption_);
}

void LiveInput::handle(const LiveRequests& requests) {
  wantsToQuit_ = wantsToQuit_ || requests.quit;
  wantsSnapshot_ = wantsSnapshot_ || requests.snapshot;
  wantsLookFile_ = wantsLookFile_ || requests.saveLook;
  wantsCommandLine_ = wantsCommandLine_ || requests.commandLine;
  if (requests.tuned) controls_.setParameters({tuning_.styleName(), tuning_.parameters()});
}

bool LiveInput::takeSnapshotRequest() {
  return std::exchange(wantsSnapshot_, false);
}

std::optional<std::string> LiveInput::takeLookFile() {
  if (!std::exchange(wantsLookFile_, false)) return std::nullopt;
  return tuning_.lookFile();
}

std::optional<std::string> LiveInput::takeCommandLine() {
  if (!std::exchange(wantsCommandLine_, false)) return std::nullopt;
  std::vector<std::string> words = job_.command;
  for (std::string& each : tuning_.arguments()) words.push_back(std::move(each));
  std::string text = shellText(words);
  if (window_) window_->copy(text);
  return text;
}

void LiveInput::setParameters(const LiveParameters& parameters) {
  tuning_.setParameters(parameters.style, parameters.painting);
  controls_.setParameters(parameters);
}

void LiveInput::notify(const std::string& text) {
  if (window_) window_->notify(text);
  const bool isSomebodyThere = keyPressed_ && job_.clock->now() - *keyPressed_ < kAtTheKeys;
  if (isSomebodyThere) displayCaption_.notify(text);
}

void LiveInput::noteOutputs(const std::vector<runtime::OutputStage::Status>& outputs) {
  isDisplayTaken_ = std::ranges::any_of(outputs, isTaken);
}

}  // namespace pleinair::app
