#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "hal/camera.h"
#include "hal/clock.h"

namespace pleinair::hal {

/// The path that means standard input: a movie in a container that can be read from its beginning
/// to its end, such as Y4M or Matroska.
inline constexpr const char* kStandardInput = "-";

struct RecordingOptions {
  Pacing pacing = Pacing::kStepped;
  /// Starts over at the end, also at the end of a truncated recording; sequence numbers and times
  /// go on.
  bool loop = false;
  /// The time between pictures of a folder or pattern.
  Duration picturePeriod = std::chrono::nanoseconds(std::chrono::seconds(1)) / 30;
  /// The part that is played: from the first frame at or after `from` to the last one before `to`,
  /// in the recording's time, which begins at 0. A single picture is always played.
  Duration from{0};
  std::optional<Duration> to = std::nullopt;
  /// Called with the error of each picture of a folder or pattern that is broken and left out, on
  /// the thread that calls the camera; null: nobody is told.
  std::function<void(const Error&)> onSkipped = nullptr;
};

/// A recorded camera. `path` is
/// - kStandardInput,
/// - a movie (MP4, MKV, Y4M, or any other local file that libav demuxes),
/// - one picture (PNG, JPEG, BMP, TIFF, WebP, PNM; HEIC and AVIF where libheif is built in),
/// - a folder of such pictures, in natural order of their names; other files in it are ignored,
/// - a pattern such as "in/%04d.png": from the smallest existing number up to the first gap.
///
/// Frames in I420, NV12, YUYV, grey or RGB8 are lent as stored, without a copy; other formats are
/// converted to RGB8 (alpha over white; 16-bit grey to grey). HDR is tone-mapped, wide gamuts are
/// converted to sRGB's, and more than 8 bits of Y'CbCr are dithered to RGB8. Pixels that are not
/// square are resampled. The display matrix of a movie and the
/// EXIF orientation of a JPEG are applied if they are quarter turns or mirrors: such frames are
/// delivered as upright copies (YUYV as RGB8), with the size turned, too. Other angles are ignored.
/// captureTime is the clock's time at start() plus the frame's own time since the first frame,
/// exact to 1 ns; missing and falling timestamps are corrected. Broken frames, and those predicted
/// from them, are skipped and counted in droppedBefore. A truncated recording ends with EndOfStream
/// and `truncated`; a recording without a valid frame is an error of start().
///
/// The clock must outlive the camera. No file is opened before start().
std::unique_ptr<Camera> openRecording(std::filesystem::path path, Clock& clock,
                                      RecordingOptions options = {});

}  // namespace pleinair::hal
