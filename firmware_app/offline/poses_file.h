#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "hal/clock.h"
#include "hal/error.h"
#include "hal/pending_file.h"
#include "pipeline/tracking/pose/tracker.h"

namespace pleinair::app {

/// What was tracked, as one JSON object a line and frame:
///   frame           counted from 0
///   time_s          since the first frame
///   cameraFromWorld 16 numbers by rows; absent without a world or when lost
///   worldSource     "carried" where no tag tells it in this frame, but features of the picture do
///   tags            by rising id: id; corners, 4 × [x, y] px of the captured frame, pixel centres
///   at
///                   +0.5, AprilTag's order; cameraFromTag (AprilTag's tag frame), where the tag's
///                   size and the camera are known; source: "carried" where it is not seen
///   rejected        what was read and not used, by reason, where anything was: faint, duplicate,
///                   unknown, mirrored, small, degenerate; ambiguous and contradicting are used
class PosesFile {
 public:
  /// Errors as PendingFile::create. Nothing stands under the name until publish().
  static hal::Result<PosesFile> create(const std::filesystem::path& path);

  hal::Result<void> write(std::uint64_t frame, hal::Duration time,
                          const tracking::TrackingResult& tracking);
  hal::Result<void> publish();

 private:
  explicit PosesFile(hal::PendingFile file) : file_(std::move(file)) {}

  hal::PendingFile file_;
};

/// One line of the file, with its newline.
std::string posesLine(std::uint64_t frame, hal::Duration time,
                      const tracking::TrackingResult& tracking);

}  // namespace pleinair::app
