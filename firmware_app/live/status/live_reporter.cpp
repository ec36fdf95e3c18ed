#include "firmware_app/live/status/live_reporter.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "firmware_app/cli/standard_streams.h"
#include "pipeline/runtime/status/status_text.h"

namespace pleinair::app {
namespace {

constexpr const char* kClearLine = "\r\033[K";
constexpr hal::Duration kLineInterval = std::chrono::milliseconds(250);

}  // namespace

LiveReporter::LiveReporter(std::vector<std::string> qualityNames)
    : qualityNames_(std::move(qualityNames)), isTerminal_(isatty(STDERR_FILENO) == 1) {}

LiveReporter::~LiveReporter() {
  if (isDrawn_) writeText(stderr, "\n");
}

void LiveReporter::interrupt() {
  if (!std::exchange(isDrawn_, false)) return;
  writeText(stderr, kClearLine);
}

template <class... Arguments>
void LiveReporter::warn(const char* format, const Arguments&... arguments) {
  interrupt();
  spdlog::warn(fmt::runtime(format), arguments...);
}

template <class... Arguments>
void LiveReporter::inform(const char* format, const Arguments&... arguments) {
  interrupt();
  spdlog::info(fmt::runtime(format), arguments...);
}

void LiveReporter::update(const runtime::RuntimeStatus& status, hal::TimePoint now) {
  reportCamera(status);
  reportPainting(status);
  reportOutputs(status);
  last_ = status;
  if (!isTerminal_ || (drawn_ && now - *drawn_ < kLineInterval)) return;
  drawn_ = now;
  isDrawn_ = true;
  writeText(stderr, kClearLine + runtime::statusLine(status, qualityNames_));
  std::fflush(stderr);
}

void LiveReporter::reportCamera(const runtime::RuntimeStatus& status) {
  const runtime::CaptureStage::Status& camera = status.camera;
  if (camera.format && camera.format->warning != lastWarning_) {
    lastWarning_ = camera.format->warning;
    if (!lastWarning_.empty()) {
      warn("{}: {}", camera.camera ? camera.camera->id : "camera", lastWarning_);
    }
  }
  if (last_ && last_->camera.state == camera.state) return;
  const std::string name = camera.camera ? camera.camera->id : "camera";
  if (camera.state == hal::CameraState::kStreaming) {
    if (std::exchange(wasLost_, false)) inform("{}: frames come again", name);
    return;
  }
  const bool isTrouble = camera.state == hal::CameraState::kStalled ||
                         camera.state == hal::CameraState::kLost ||
                         camera.state == hal::CameraState::kBackingOff;
  if (!isTrouble || camera.hasEnded) return;
  const bool isAgain = std::exchange(wasLost_, true);
  if (camera.state == hal::CameraState::kStalled) {
    warn("{}: {}", name, camera.reason);
    return;
  }
  // Lost and backing off alternate at every attempt; each cause is reported once.
  const bool isNews = !isAgain || lastLoss_ != camera.lastLoss;
  lastLoss_ = camera.lastLoss;
  if (isNews) warn("{}: lost: {}; it is tried again until it is back", name, camera.lastLoss);
}

void LiveReporter::reportPainting(const runtime::RuntimeStatus& status) {
  const runtime::PaintStage::Status& now = status.painting;
  const runtime::PaintStage::Status before =
      last_ ? last_->painting : runtime::PaintStage::Status{.hasPainter = true};
  if (now.latencyRaised > before.latencyRaised) {
    warn("painting takes too long at quality {}: latency raised to {:.0f} ms",
         qualityNames_.at(now.quality), hal::toMilliseconds(now.latency));
  }
  if (now.latencyLowered > before.latencyLowered && now.latency == now.configuredLatency) {
    inform("latency is back at {:.0f} ms", hal::toMilliseconds(now.latency));
  }
  if (now.contextLosses > before.contextLosses && now.failure) {
    warn("{}; a new context is made", now.failure->message());
  }
  if (now.hasPainter && !before.hasPainter && now.contextLosses > 0 && !before.isRenewing) {
    inform("painting goes on with a new context");
  }
  if (now.failures > before.failures && now.failure && now.failure->message() != lastRefusal_) {
    lastRefusal_ = now.failure->message();
    warn("a frame was not painted: {}", lastRefusal_);
  }
}

/// Null for an output that was added since.
const runtime::OutputStage::Status* LiveReporter::lastStatusOf(const std::string& output) const {
  if (!last_) return nullptr;
  const auto found = std::ranges::find(last_->outputs, output, &runtime::OutputStage::Status::name);
  return found == last_->outputs.end() ? nullptr : &*found;
}

void LiveReporter::reportOutputs(const runtime::RuntimeStatus& status) {
  for (const runtime::OutputStage::Status& output : status.outputs) {
    const runtime::OutputStage::Status* last = lastStatusOf(output.name);
    const std::uint64_t before = last != nullptr ? last->failures : 0;
    const bool wasFailed = last != nullptr && last->isFailed;
    if (output.failures > before && output.failure && !wasFailed) {
      warn("{}{}", output.failure->message(), output.isFinal ? "" : "; trying again");
    }
    if (wasFailed && !output.isFailed) inform("{}: takes images again", output.name);
    const bool wasSuspended = last != nullptr && last->suspension;
    if (output.suspension && !wasSuspended) {
      inform("{}: shows nothing: {}", output.name, output.suspension->reason);
    }
    if (wasSuspended && !output.suspension && !output.isFailed) {
      inform("{}: shows pictures again", output.name);
    }
  }
}

}  // namespace pleinair::app
