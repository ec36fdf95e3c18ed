#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "firmware_app/live/interaction/live_input.h"
#include "firmware_app/live/live_controls.h"
#include "firmware_app/live/live_job.h"
#include "firmware_app/repair_station/live_overlay.h"
#include "firmware_app/repair_station/live_procedure.h"
#include "firmware_app/repair_station/seen_tags.h"
#include "hal/pixel_format.h"
#include "pipeline/engine/painter.h"

namespace pleinair::app {

/// Follows a procedure while painting goes on: frames tell it which tags they show and bring the
/// stills that it wants; its steps, notices and failures go to the overlay, the log and the people.
/// Main thread.
class ProcedureFollower {
 public:
  /// Shows and logs a text.
  using Notify = std::function<void(const std::string& text, bool isGood)>;

  /// All references outlive this. Precondition: the job has a procedure.
  ProcedureFollower(const LiveJob& job, LiveControls& controls, LiveInput& input, Notify notify);

  /// Shows the steps over pictures of this size from now on.
  void makeOverlay(hal::FrameSize picture);
  /// Where the machine is in the scene.
  const MachinePlace& machine() const { return machine_; }
  /// For each painter in turn, which adds what it finds.
  const std::shared_ptr<overlay::DoubtfulTags>& doubtfulTags() const { return doubtfulTags_; }

  /// Handles what has happened since the last call. `isPainting`: frames flow, so that a still can
  /// be taken.
  void update(bool isPainting);
  /// A text of the step that has begun since the last call, for the log; nothing where it has not.
  std::optional<std::string> takeStep();
  /// Waits until what was answered is on the disk, until `deadline` at most, or for 0.3 s where
  /// that is sooner. Nothing may be given afterwards; another call gives the same answer.
  LiveProcedure::RecordEnd end(std::chrono::steady_clock::time_point deadline);

 private:
  void showTexts();

  const LiveJob& job_;
  LiveProcedure& procedure_;
  LiveControls& controls_;
  LiveInput& input_;
  Notify notify_;
  MachinePlace machine_;
  std::shared_ptr<overlay::DoubtfulTags> doubtfulTags_ = std::make_shared<overlay::DoubtfulTags>();
  std::optional<LiveOverlay> overlay_;  ///< once the pictures' size is known
  std::string loggedStep_;
  std::optional<LiveProcedure::RecordEnd> end_;
};

}  // namespace pleinair::app
