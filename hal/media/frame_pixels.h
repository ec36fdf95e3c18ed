#pragma once

#include <memory>
#include <optional>

#include "hal/error.h"
#include "hal/image.h"
#include "hal/media/handles.h"
#include "hal/media/orientation.h"

namespace pleinair::hal::libav {

/// A decoded image in one of the HAL's formats; `lease` keeps its planes alive.
struct LentPicture {
  ImageView view;
  std::shared_ptr<const void> lease;
};

/// The Y'CbCr encoding of a frame, from its tags. Defaults: full range for the JPEG layouts, else
/// limited; BT.709 from 720 lines up, else BT.601. Nothing for another encoding (BT.2020).
std::optional<ColorEncoding> encodingOf(const AVFrame& frame);

/// The orientation of a frame, from its display matrix; upright without one.
Orientation orientationOf(const AVFrame& frame);

/// The size of a frame once its pixels are square: the side that the pixels' aspect (width to
/// height) stretches is enlarged, or the other one reduced where that would exceed the limits. The
/// stored size without an aspect, or with one that is not within 1:8 and 8:1.
FrameSize squarePixelSize(FrameSize stored, AVRational aspect);

/// kRgb: RGB8 always. kRgba: RGBA8 always, with alpha, rows and columns as stored.
enum class Delivery { kAsStored, kRgb, kRgba };

/// Converts a frame. I420, NV12, YUYV, grey and RGB8 are lent without a copy; 16-bit grey becomes
/// grey, every other layout becomes RGB8 with alpha over white. HDR, wide gamuts and colours of
/// more than 8 bits become RGB8 by toSrgb(), those of another ICC profile than sRGB's by
/// IccConversion (neither for kRgba: textures have no profiles, glTF 2.0 §3.9.2). Pixels that are
/// not square are resampled (squarePixelSize(); not for kRgba). If the display matrix turns or
/// mirrors the frame, the result is an upright copy (YUYV as RGB8). Errors: kUnsupported (size
/// beyond the limits, or a layout or colour space that cannot be converted).
Result<LentPicture> lendPicture(const std::shared_ptr<const AVFrame>& frame,
                                Delivery delivery = Delivery::kAsStored);

}  // namespace pleinair::hal::libav
