#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "hal/pixel_format.h"

namespace pleinair::hal::libav {

enum class PictureKind { kPng, kJpeg, kBmp, kTiff, kWebp, kPnm };

/// What the first bytes say that a file is: its signature only.
std::optional<PictureKind> pictureKindOf(std::span<const std::uint8_t> bytes);

/// The size that the header of a whole file in memory gives, before anything is decoded. Nothing
/// where it has none in reach (also of a broken file); TIFF is not looked into.
std::optional<FrameSize> peekPictureSize(PictureKind kind, std::span<const std::uint8_t> bytes);

/// What is wrong with a whole file in memory that libav would gloss over (it fills what a JPEG
/// lacks with grey, and shows a palette picture without its palette): "breaks off before its end".
/// Nothing where no such flaw is found.
std::optional<std::string_view> flawOf(PictureKind kind, std::span<const std::uint8_t> bytes);

}  // namespace pleinair::hal::libav
