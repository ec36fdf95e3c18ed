#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "firmware_app/live/live_controls.h"
#include "firmware_app/live/live_job.h"
#include "firmware_app/live/live_keys.h"
#include "firmware_app/live/live_reporter.h"
#include "firmware_app/live/live_tuning.h"
#include "firmware_app/live/live_window.h"
#include "firmware_app/live/presence.h"
#include "hal/clock.h"
#include "hal/console/virtual_terminal.h"
#include "pipeline/runtime/live_pipeline.h"

namespace pleinair::app {

/// The people at a live painting: the keys they press, in a window or on a bare display, the
/// console they switch to, and whether anybody is there. Main thread.
class LiveInput {
 public:
  /// All references outlive this. Takes the console where an output appears on it, and opens
  /// keyboards where the job has some.
  LiveInput(const LiveJob& job, LiveControls& controls, LiveReporter& reporter);
  ~LiveInput();
  LiveInput(const LiveInput&) = delete;
  LiveInput& operator=(const LiveInput&) = delete;

  void openWindow(hal::Window& window) { window_.emplace(window, tuning_, *job_.clock); }
  /// Keyboards may have come or gone. Any thread.
  void devicesChanged();

  /// Handles what has happened since the last call. `pipeline`: null until it is complete.
  /// `movedAt`: the last movement before the camera. Returns whether our console has come to the
  /// front: displays that could not be opened may be free.
  bool poll(runtime::LivePipeline* pipeline, std::optional<hal::TimePoint> movedAt);
  /// Handles the window's keys and updates its caption; nothing where there is none. Errors: those
  /// of hal::Window::redraw().
  hal::Result<void> updateWindow(runtime::LivePipeline& pipeline, double framesPerSecond);
  /// Shows a notice in the window's caption.
  void notify(const std::string& text);
  /// Whether another console or program has a display: keys are for that one.
  void noteOutputs(const std::vector<runtime::OutputStage::Status>& outputs);
  /// Gives the console back. Afterwards only destruction is allowed.
  void releaseConsole() { terminal_.reset(); }

  bool wantsToQuit() const { return wantsToQuit_; }
  /// Whether a snapshot was asked for since the last call.
  bool takeSnapshotRequest();

 private:
  void takeConsole();
  bool followConsole();
  bool handleKeys(runtime::LivePipeline* pipeline);
  void handle(const LiveRequests& requests);

  const LiveJob& job_;
  LiveControls& controls_;
  LiveReporter& reporter_;
  LiveTuning tuning_;
  std::unique_ptr<hal::VirtualTerminal> terminal_;
  std::optional<LiveWindow> window_;
  std::optional<LiveKeys> keys_;
  Presence presence_;
  hal::TimePoint captioned_;
  bool wantsToQuit_ = false;
  bool wantsSnapshot_ = false;
  bool isDisplayTaken_ = false;
};

}  // namespace pleinair::app
