#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "hal/clock.h"
#include "hal/error.h"
#include "hal/pending_file.h"
#include "pipeline/tracking/pose/tracker.h"

namespace pleinair::app {

/// The tracking results, one JSON object per line and frame:
///   frame           counted from 0
///   time_s          since the first frame
///   cameraFromWorld 16 numbers by rows; absent without a world or when lost
///   worldSource     "carried" if no tag gave the pose in this frame, but image features did
///   tags            in rising order of id: id; corners, 4 × [x, y] px of the captured frame, pixel
///                   centres at +0.5, AprilTag's order; cameraFromTag (AprilTag's tag frame), if
///                   the tag's size and the camera are known; source: "carried" if the tag was not
///                   detected in this frame
///   rejected        counts of unused detections, by reason: faint, duplicate, unknown, mirrored,
///                   small, degenerate; and of used ones that are ambiguous or contradicting.
///                   Absent without any
class PosesFile {
 public:
  /// Creates the file, which takes its name in publish(). Errors as PendingFile::create.
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
