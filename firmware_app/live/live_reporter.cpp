#include "firmware_app/live/live_reporter.h"

#include <chrono>
#include <cstdio>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "pipeline/runtime/status_text.h"

namespace pleinair::app {
namespace {

constexpr const char* kClearLine = "\r\033[K";
constexpr hal::Duration kBetweenLines = std::chrono::milliseconds(250);

}  // namespace

LiveReporter::LiveReporter(std::vector<std::string> qualityNames)
    : qualityNames_(std::move(qualityNames)), isTerminal_(isatty(STDERR_FILENO) == 1) {}

LiveReporter::~LiveReporter() {
  if (isDrawn_) fmt::print(stderr, "\n");
}

void LiveReporter::interrupt() {
  if (!std::exchange(isDrawn_, false)) return;
  fmt::print(stderr, "{}", kClearLine);
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
  tellCamera(status);
  tellPainting(status);
  tellOutputs(status);
  last_ = status;
  if (!isTerminal_ || (drawn_ && now - *drawn_ < kBetweenLines)) return;
  drawn_ = now;
  isDrawn_ = true;
  fmt::print(stderr, "{}{}", kClearLine, runtime::statusLine(status, qualityNames_));
  std::fflush(stderr);
}

void LiveReporter::tellCamera(const runtime::RuntimeStatus& status) {
  const runtime::CaptureStage::Status& camera = status.camera;
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
  // Lost and backing off follow each other at once, and again at every try: one line for each
  // cause.
  const bool isNews = !isAgain || lastLoss_ != camera.lastLoss;
  lastLoss_ = camera.lastLoss;
  if (isNews) warn("{}: lost: {}; it is tried again until it is back", name, camera.lastLoss);
}

void LiveReporter::tellPainting(const runtime::RuntimeStatus& status) {
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
  if (now.hasPainter && !before.hasPainter && now.contextLosses > 0) {
    inform("painting goes on with a new context");
  }
  if (now.failures > before.failures && now.failure && now.failure->message() != lastRefusal_) {
    lastRefusal_ = now.failure->message();
    warn("a frame was not painted: {}", lastRefusal_);
  }
}

void LiveReporter::tellOutputs(const runtime::RuntimeStatus& status) {
  for (std::size_t i = 0; i < status.outputs.size(); ++i) {
    const auto& output = status.outputs.at(i);
    const std::uint64_t before = last_ ? last_->outputs.at(i).failures : 0;
    const bool wasFailed = last_ && last_->outputs.at(i).isFailed;
    if (output.failures > before && output.failure && !wasFailed) {
      warn("{}{}", output.failure->message(), output.isFinal ? "" : "; trying again");
    }
    if (wasFailed && !output.isFailed) inform("{}: takes pictures again", output.name);
  }
}

}  // namespace pleinair::app
