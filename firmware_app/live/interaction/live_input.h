#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "firmware_app/live/interaction/display_captions.h"
#include "firmware_app/live/interaction/live_caption.h"
#include "firmware_app/live/interaction/live_keys.h"
#include "firmware_app/live/interaction/live_tuning.h"
#include "firmware_app/live/interaction/live_window.h"
#include "firmware_app/live/interaction/presence.h"
#include "firmware_app/live/live_controls.h"
#include "firmware_app/live/live_job.h"
#include "firmware_app/live/status/live_reporter.h"
#include "firmware_app/repair_station/seen_tags.h"
#include "firmware_app/repair_station/step_inputs.h"
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

  /// Does nothing where one is open.
  void openWindow(hal::Window& window) {
    if (!window_) window_.emplace(window, tuning_, *job_.clock);
  }
  /// Keyboards may have come or gone. Any thread.
  void devicesChanged();

  /// Handles what has happened since the last call. `pipeline`: null until it is complete.
  /// `movedAt`: the last movement before the camera. Returns whether our console has come to the
  /// front: displays that could not be opened may be free.
  bool poll(runtime::LivePipeline* pipeline, std::optional<hal::TimePoint> movedAt);
  /// Handles the window's keys and updates its caption; nothing where there is none. `pipeline`:
  /// null until it is complete. Errors: those of hal::Window::redraw().
  hal::Result<void> updateWindow(runtime::LivePipeline* pipeline, double framesPerSecond);
  /// Shows on bare displays what a window would show in its caption: an answer to each key, and the
  /// step of a procedure. `displays` outlive this.
  void updateDisplays(const std::vector<runtime::OutputStage*>& displays);
  /// Replaces the parameters that keys have tuned, from the next frame on.
  void setParameters(const LiveParameters& parameters);
  /// Shows a notice in the window's caption, and on bare displays where somebody is at the keys.
  void notify(const std::string& text);
  /// Takes what a frame shows: command cards.
  void see(const SeenTags& tags);
  /// Whether another console or program has a display: keys are for that one.
  void noteOutputs(const std::vector<runtime::OutputStage::Status>& outputs);
  /// Gives the console back. Afterwards only destruction is allowed.
  void releaseConsole() { terminal_.reset(); }

  bool wantsToQuit() const { return wantsToQuit_; }
  /// Whether the picture is held.
  bool isPaused() const { return tuning_.isPaused(); }
  /// Whether a snapshot was asked for since the last call.
  bool takeSnapshotRequest();
  /// A look file to be saved, or the command line to be shown, where one was asked for since the
  /// last call.
  std::optional<std::string> takeLookFile();
  std::optional<std::string> takeCommandLine();

 private:
  void takeConsole();
  bool followConsole();
  bool handleKeys(runtime::LivePipeline* pipeline);
  bool handleSteps();
  void handle(const LiveRequests& requests);
  std::string pinnedText(const std::string& step) const;

  const LiveJob& job_;
  LiveControls& controls_;
  LiveReporter& reporter_;
  LiveTuning tuning_;
  std::unique_ptr<hal::VirtualTerminal> terminal_;
  std::optional<LiveWindow> window_;
  std::optional<LiveKeys> keys_;
  LiveCaption displayCaption_;
  DisplayCaptions displayCaptions_;
  std::optional<hal::TimePoint> keyPressed_;  ///< on a keyboard of keys_
  hal::TimePoint displaysCaptioned_;
  std::optional<StepInputs> steps_;  ///< beside keys, where there is a procedure
  Presence presence_;
  hal::TimePoint captioned_;
  bool wantsToQuit_ = false;
  bool wantsSnapshot_ = false;
  bool wantsLookFile_ = false;
  bool wantsCommandLine_ = false;
  bool isDisplayTaken_ = false;
};

}  // namespace pleinair::app
