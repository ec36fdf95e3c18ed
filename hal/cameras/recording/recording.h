#pragma once

#include <chrono>
#include <filesystem>
#include <memory>

#include "hal/camera.h"
#include "hal/clock.h"

namespace pleinair::hal {

struct RecordingOptions {
  Pacing pacing = Pacing::kStepped;
  /// Starts over at the end; sequence and times go on. Where a recording breaks off, too.
  bool loop = false;
  /// Time between pictures of a folder or pattern.
  Duration picturePeriod = std::chrono::nanoseconds(std::chrono::seconds(1)) / 30;
};

/// A recorded camera. `path` is
/// - a movie (MP4, MKV, Y4M, whatever libav demuxes from one local file),
/// - one picture (PNG, JPEG, BMP, TIFF, WebP, PNM),
/// - a folder of such pictures, in natural order of their names; other files in it are ignored,
/// - a pattern such as "in/%04d.png": from the smallest number that exists up to the first gap.
///
/// Frames come as stored where that is I420, NV12, YUYV, grey or RGB8, lent without a copy; else as
/// RGB8 (alpha over white; 16-bit grey as grey). Movies' display matrices and JPEGs' EXIF
/// orientation are applied: frames that they turn or mirror by quarters come as upright copies
/// (YUYV as RGB8), their size turned too; other angles are ignored. captureTime is the clock's time
/// at start() plus the frame's own since the first: exact to 1 ns of what the file says; missing
/// and falling timestamps are fixed. Broken frames, and those predicted from them, are left out
/// and counted in droppedBefore. A recording that breaks off answers EndOfStream with `truncated`;
/// one without any sound frame is an error of start().
///
/// The clock must outlive the camera. Nothing is opened before start().
std::unique_ptr<Camera> openRecording(std::filesystem::path path, Clock& clock,
                                      RecordingOptions options = {});

}  // namespace pleinair::hal
