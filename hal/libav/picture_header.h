#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "hal/pixel_format.h"

namespace pleinair::hal::libav {

enum class PictureKind { kPng, kJpeg, kBmp, kTiff, kWebp, kPnm };

/// What the first bytes say that a file is: its signature only.
std::optional<PictureKind> pictureKindOf(std::span<const std::uint8_t> bytes);

/// The size that the header of a whole file in memory gives, before anything is decoded. Nothing
/// where it has none in reach (also of a broken file); TIFF is not looked into.
std::optional<FrameSize> peekPictureSize(PictureKind kind, std::span<const std::uint8_t> bytes);

/// Whether the file runs to its proper end. Only JPEG needs to be asked: libav fills what is
/// missing of it with grey and calls that sound.
bool hasProperEnd(PictureKind kind, std::span<const std::uint8_t> bytes);

}  // namespace pleinair::hal::libav
