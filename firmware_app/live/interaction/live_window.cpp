#include "firmware_app/live/interaction/live_window.h"

#include <chrono>
#include <variant>

#include <fmt/format.h>

#include "hal/overloaded.h"

namespace pleinair::app {
namespace {

/// Period of drawing the caption while no image draws it.
constexpr hal::Duration kRedrawPeriod = std::chrono::milliseconds(33);

}  // namespace

LiveWindow::LiveWindow(hal::Window& window, LiveTuning& tuning, const hal::Clock& clock)
    : window_(window), tuning_(tuning), clock_(clock), caption_(tuning, clock) {
  caption_.notify("h: help");
}

LiveWindow::Requests LiveWindow::takeRequests() {
  Requests requests;
  for (const hal::WindowEvent& event : window_.takeEvents()) {
    std::visit(hal::Overloaded{[&](const hal::KeyPressed& key) { press(key, requests); },
                               [&](const hal::WindowClosed&) { requests.quit = true; },
                               [](const hal::WindowResized&) {}},  // the window scales by itself
               event);
  }
  return requests;
}

void LiveWindow::press(const hal::KeyPressed& key, Requests& requests) {
  const LiveTuning::Request request = tuning_.press(key);
  if (request == LiveTuning::Request::kUnknownKey) return;
  requests.tuned = true;
  caption_.keyPressed();
  if (request == LiveTuning::Request::kQuit) requests.quit = true;
  if (request == LiveTuning::Request::kSnapshot) requests.snapshot = true;
  if (request == LiveTuning::Request::kSaveLook) requests.saveLook = true;
  if (request == LiveTuning::Request::kCommandLine) requests.commandLine = true;
  if (request == LiveTuning::Request::kFullScreen) {
    isFullScreen_ = !isFullScreen_;
    window_.setFullScreen(isFullScreen_);
  }
}

hal::Result<void> LiveWindow::update(double framesPerSecond, bool imageFollows) {
  const hal::TimePoint now = clock_.now();
  if (!imageFollows && now - updated_ < kRedrawPeriod) return {};
  updated_ = now;
  window_.setTitle(fmt::format("pleinair: {}", tuning_.state()));
  const LiveCaption::Shown caption = caption_.shown(framesPerSecond);
  window_.setCaption(caption.text, caption.opacity);
  const bool isSeen = caption.opacity > 0.0 || drawnOpacity_ > 0.0;
  drawnOpacity_ = caption.opacity;
  if (!imageFollows && isSeen) return window_.redraw();
  return {};
}

}  // namespace pleinair::app
