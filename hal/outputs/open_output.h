#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "hal/output.h"

namespace pleinair::hal {

/// The output that `path` names: a movie (.mp4, .mkv, .y4m), one .png, a numbered pattern such as
/// "out/%04d.png", or a folder of numbered PNGs (one that exists, ends in a slash, or has no
/// ending). Opens nothing yet. Errors: kInvalidArgument (another ending; lists those that are
/// known).
Result<std::unique_ptr<MemoryOutput>> openFileOutput(const std::filesystem::path& path);

/// What only some outputs ask for.
struct OutputOptions {
  /// Of a loopback: kYuyv, kNv12 or kI420; unset: what the device takes.
  std::optional<PixelFormat> loopbackLayout;
};

/// As openFileOutput(); "window" is a hal::Window; "loopback", "loopback:/dev/video50" and
/// "loopback:LABEL" are V4L2 devices (openLoopback()). Errors also: kNotFound (there is no
/// display), kUnsupported (this build has no window).
Result<std::unique_ptr<MemoryOutput>> openOutput(const std::string& name,
                                                 const OutputOptions& options = {});

/// Whether openOutput() takes `name` for a path, not for a device.
bool isFileOutputName(const std::string& name);

}  // namespace pleinair::hal
