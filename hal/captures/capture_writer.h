#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "hal/camera.h"
#include "hal/captured_frame.h"
#include "hal/error.h"

namespace pleinair::hal::captures {

/// What stands at the beginning of a recording.
struct CaptureHeader {
  CameraIdentity camera;
  StreamFormat format;
  std::string request;  ///< size, rate and controls that the camera was asked for, for people
};

/// Records what a camera does, to the bit: frames in FFV1, without loss, in Matroska; and beside
/// each frame, in a track of text, what the camera said about it (frame_facts.h). The camera
/// "recording" plays it with the same pixels, times, losses and health.
///
/// The file takes its name when finish() has succeeded. One thread.
class CaptureWriter {
 public:
  /// `start`: when the stream began, from which times are counted. Errors: those of
  /// PendingFile::create(); kUnsupported (a libav without FFV1).
  static Result<std::unique_ptr<CaptureWriter>> open(const std::filesystem::path& path,
                                                     const CaptureHeader& header, TimePoint start);
  virtual ~CaptureWriter() = default;
  CaptureWriter() = default;
  CaptureWriter(const CaptureWriter&) = delete;
  CaptureWriter& operator=(const CaptureWriter&) = delete;

  /// Precondition: the frame's format is the header's. Errors: kNoSpace, kIo.
  virtual Result<void> write(const CapturedFrame& frame) = 0;
  virtual Result<void> finish() = 0;
};

}  // namespace pleinair::hal::captures
