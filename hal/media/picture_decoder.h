#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "hal/error.h"
#include "hal/media/file_input.h"
#include "hal/media/handles.h"
#include "hal/pixel_format.h"

namespace pleinair::hal::libav {

/// "WxH px is too large": the error of every reader for a header beyond the limits.
Error tooLarge(std::string subject, FrameSize size);

/// Decodes a picture file. Truncated or corrupt files are refused, never shown in part. The size in
/// the header is checked first. The frame is as stored, with a JPEG's EXIF orientation as its
/// display matrix. Errors: as FileInput::open, and kInvalidInput (not a picture, broken),
/// kUnsupported (size, coding).
Result<std::shared_ptr<const AVFrame>> decodePicture(const std::filesystem::path& path);

/// Decodes a picture file in memory; `subject` names it in errors.
Result<std::shared_ptr<const AVFrame>> decodePicture(std::span<const std::uint8_t> bytes,
                                                     const std::string& subject);

}  // namespace pleinair::hal::libav
