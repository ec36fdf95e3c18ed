#pragma once

#include <memory>
#include <optional>

#include "hal/error.h"
#include "hal/image.h"
#include "hal/media/handles.h"
#include "hal/media/orientation.h"

namespace pleinair::hal::libav {

/// A decoded picture in a format of ours: planes lent by `lease`.
struct LentPicture {
  ImageView view;
  std::shared_ptr<const void> lease;
};

/// The Y'CbCr encoding of a frame: its tags; where it has none, full range for the JPEG layouts,
/// else limited; BT.709 from 720 lines up, else BT.601. Nothing where it is another one (BT.2020).
std::optional<ColorEncoding> encodingOf(const AVFrame& frame);

/// Of the frame's display matrix; upright where it has none.
Orientation orientationOf(const AVFrame& frame);

/// kRgb: RGB8 always. kRgba: RGBA8 always, alpha kept, rows and columns as stored.
enum class Delivery { kAsStored, kRgb, kRgba };

/// The frame as I420, NV12, YUYV, grey or RGB8 without a copy where its layout is one of these;
/// else converted: 16-bit grey to grey, everything else to RGB8, alpha laid over white paper.
/// Where its display matrix turns or mirrors it, an upright copy (of YUYV as RGB8).
/// Errors: kUnsupported (size beyond the limits, or a layout that libav cannot convert).
Result<LentPicture> lendPicture(const std::shared_ptr<const AVFrame>& frame,
                                Delivery delivery = Delivery::kAsStored);

}  // namespace pleinair::hal::libav
