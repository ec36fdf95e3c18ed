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

/// "WxH px is too large", as every reader refuses a header beyond the limits.
Error tooLarge(std::string subject, FrameSize size);

/// Decodes a whole picture; a truncated or corrupt one is refused, never half shown. Its size is
/// checked in the header first. The frame comes as stored; a JPEG's has its EXIF orientation as a
/// display matrix. Errors: as FileInput::open, and kInvalidInput (not a picture, broken),
/// kUnsupported (size, coding).
Result<std::shared_ptr<const AVFrame>> decodePicture(const std::filesystem::path& path);

/// The same for a whole file in memory; `subject` names it in errors.
Result<std::shared_ptr<const AVFrame>> decodePicture(std::span<const std::uint8_t> bytes,
                                                     const std::string& subject);

}  // namespace pleinair::hal::libav
