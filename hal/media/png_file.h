#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "hal/error.h"
#include "hal/image.h"

namespace pleinair::hal {

/// Statements of a PNG about its pixels (ISO/IEC 15948 §11.3.2.5, §11.3.4.3).
struct PngTags {
  bool isSrgb = false;
  std::optional<double> dotsPerInch = std::nullopt;
};

/// Encodes RGB8, RGBA8 or grey as a PNG file in memory, for speed rather than size. The same
/// picture gives the same bytes. Errors: kUnsupported (format).
Result<std::vector<std::uint8_t>> encodePng(const ImageView& picture, const PngTags& tags = {});

/// Writes RGB8, RGBA8 or grey as PNG, under a temporary name until complete. Errors: kNotFound (no
/// such folder), kPermissionDenied, kNoSpace, kUnsupported (format), kIo.
Result<void> writePng(const std::filesystem::path& path, const ImageView& picture);

/// Reads a PNG file that this program has written, as RGB8: without libav, which takes long to
/// load; readPicture() reads those of others. Errors: kNotFound, kPermissionDenied, kInvalidInput
/// (no PNG; truncated or corrupt), kUnsupported (larger than isAcceptedSize), kIo.
Result<Image> readOwnPng(const std::filesystem::path& path);

}  // namespace pleinair::hal
