#pragma once

#include <optional>
#include <string_view>

#include "hal/image.h"
#include "hal/media/handles.h"
#include "hal/pixel_format.h"

namespace pleinair::hal::captures {

/// libav's layout in which frames of a format are stored, to the bit: other players show it as a
/// picture, but for mosaics, which they show as grey.
AVPixelFormat storedFormat(PixelFormat format);

/// Copies an image to a frame of that layout and size, with its colour encoding.
/// Precondition: the frame is writable.
void store(const ImageView& image, AVFrame& frame);

/// The image that was stored. Nothing if the frame's layout is not that of the format.
std::optional<Image> restored(const AVFrame& frame, PixelFormat format);

/// The inverse of toString(PixelFormat).
std::optional<PixelFormat> pixelFormatNamed(std::string_view name);

}  // namespace pleinair::hal::captures
