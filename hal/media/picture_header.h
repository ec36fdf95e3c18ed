#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "hal/pixel_format.h"

namespace pleinair::hal {

enum class PictureKind { kPng, kJpeg, kBmp, kTiff, kWebp, kPnm, kHeif };

/// The file type by its signature, the first bytes.
std::optional<PictureKind> pictureKindOf(std::span<const std::uint8_t> bytes);

/// The size in the header of a picture file in memory, without decoding. Nothing if no header is
/// found (also in broken files) and for TIFF and HEIF, which are not parsed.
std::optional<FrameSize> peekPictureSize(PictureKind kind, std::span<const std::uint8_t> bytes);

/// A defect of a picture file in memory that libav would hide: it fills the missing part of a JPEG
/// with grey, and shows a palette picture without its palette. For example "breaks off before its
/// end". Nothing if no such defect is found.
std::optional<std::string_view> defectOf(PictureKind kind, std::span<const std::uint8_t> bytes);

}  // namespace pleinair::hal
