#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "hal/error.h"
#include "hal/image.h"

namespace pleinair::hal {

/// Reads a PNG, JPEG, BMP, TIFF, WebP or PNM file into packed memory: grey, RGB8 and I420 as
/// stored, other formats as RGB8; alpha is composited over white. A JPEG's EXIF orientation is
/// applied. Errors: kNotFound, kPermissionDenied, kInvalidInput (not a picture; truncated or
/// corrupt), kUnsupported (larger than isAcceptedSize, refused before decoding), kIo.
Result<Image> readPicture(const std::filesystem::path& path);

/// Like readPicture(), but always as RGB8.
Result<Image> readPictureRgb(const std::filesystem::path& path);

/// Like readPicture(), but as RGBA8 with its alpha, without applying its EXIF orientation.
Result<Image> readPictureRgba(const std::filesystem::path& path);

/// Decodes a picture file in memory as RGBA8 with its alpha, without applying its EXIF orientation:
/// a model's texture. `subject` names it in errors, which are those of readPicture().
Result<Image> decodeRgba(std::span<const std::uint8_t> bytes, const std::string& subject);

/// An image of 16-bit RGB, rows packed from the top.
struct Rgb16Image {
  FrameSize size;
  std::vector<std::uint16_t> rgb;
};

/// Reads a PNG file of 16-bit RGB at full depth: the format of measurements such as KITTI's flow.
/// Errors: as readPicture(), and kInvalidInput (another depth, or no colour).
Result<Rgb16Image> readRgb16(const std::filesystem::path& path);

}  // namespace pleinair::hal
