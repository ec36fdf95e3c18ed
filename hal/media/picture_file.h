#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "hal/error.h"
#include "hal/image.h"

namespace pleinair::hal {

/// A PNG, JPEG, BMP, TIFF, WebP or PNM file, packed, in the format it is stored in where that is
/// one of ours (grey, RGB8, I420), else RGB8; alpha is laid over white. A JPEG's EXIF
/// orientation is applied: pictures come upright. Errors: kNotFound, kPermissionDenied,
/// kInvalidInput (not a picture; truncated or corrupt), kUnsupported (larger than isAcceptedSize,
/// refused before decoding), kIo.
Result<Image> readPicture(const std::filesystem::path& path);

/// The same as RGB8 whatever it is stored in.
Result<Image> readPictureRgb(const std::filesystem::path& path);

/// A whole picture file in memory as RGBA8, alpha kept, its EXIF orientation left alone: a model's
/// texture. `subject` names it in errors, which are readPicture()'s.
Result<Image> decodeRgba(std::span<const std::uint8_t> bytes, const std::string& subject);

/// RGB of 16 bits a channel, rows packed from the top.
struct DeepPicture {
  FrameSize size;
  std::vector<std::uint16_t> rgb;
};

/// A PNG file of 16-bit RGB, all bits kept: what measurements such as KITTI's flow are stored in.
/// Errors: as readPicture(), and kInvalidInput (of another depth or without colour).
Result<DeepPicture> readDeepRgb(const std::filesystem::path& path);

/// The bytes of a PNG file of RGB8, RGBA8 or grey. Errors: kUnsupported (format).
Result<std::vector<std::uint8_t>> encodePng(const ImageView& picture);

/// Writes RGB8, RGBA8 or grey as PNG, under a temporary name first. Errors: kNotFound (no such
/// folder), kPermissionDenied, kNoSpace, kUnsupported (format), kIo.
Result<void> writePng(const std::filesystem::path& path, const ImageView& picture);

}  // namespace pleinair::hal
