#pragma once

#include <cstdint>
#include <vector>

#include "hal/image.h"

namespace pleinair::tracking {

/// Makes the BT.601 luma of pictures of any format, for detectors. Bayer mosaics are interpolated
/// bilinearly, so that luma is not shifted against the picture. One thread at a time.
class LumaConverter {
 public:
  /// One byte a pixel, the picture's size: the picture's own plane where it has one, else a buffer
  /// of this object, valid until the next call. Precondition: image.isComplete().
  hal::PlaneView convert(const hal::ImageView& image);

 private:
  std::vector<std::uint8_t> buffer_;
};

}  // namespace pleinair::tracking
