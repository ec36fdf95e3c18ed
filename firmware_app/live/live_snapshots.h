#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "firmware_app/live/interaction/live_input.h"
#include "firmware_app/live/live_controls.h"
#include "firmware_app/live/snapshot_saver.h"
#include "hal/error.h"

namespace pleinair::app {

/// Takes the snapshots and look files that keys ask for to their folder. Main thread.
class LiveSnapshots {
 public:
  /// Shows and logs a text.
  using Notify = std::function<void(const std::string& text, bool isGood)>;

  /// References outlive this.
  LiveSnapshots(std::filesystem::path folder, LiveControls& controls, LiveInput& input,
                Notify notify);

  /// Handles what was asked for and what was painted since the last call.
  void update();
  /// Saves and reports the painted snapshots, at the end.
  void finish();

 private:
  bool save();
  void report(const hal::Result<std::filesystem::path>& saved);

  std::filesystem::path folder_;
  LiveControls& controls_;
  LiveInput& input_;
  Notify notify_;
  SnapshotSaver saver_;
};

}  // namespace pleinair::app
