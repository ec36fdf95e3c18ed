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

/// kRgb: RGB8 always. kRgba: RGBA8 always, with alpha, rows and columns as stored.
enum class Delivery { kAsStored, kRgb, kRgba };

/// Converts a frame. I420, NV12, YUYV, grey and RGB8 are lent without a copy; 16-bit grey becomes
/// grey, every other layout becomes RGB8 with alpha over white. If the display matrix turns or
/// mirrors the frame, the result is an upright copy (YUYV as RGB8). Errors: kUnsupported (size
/// beyond the limits, or a layout that libav cannot convert).
Result<LentPicture> lendPicture(const std::shared_ptr<const AVFrame>& frame,
                                Delivery delivery = Delivery::kAsStored);

}  // namespace pleinair::hal::libav
