#include "hal/outputs/v4l2_loopback/frame_layout.h"

#include <algorithm>
#include <cassert>

namespace pleinair::hal::loopback {

std::optional<FrameLayout> FrameLayout::of(const FrameFormat& format, std::size_t strideBytes) {
  FrameLayout layout{.format = format};
  for (int plane = 0; plane < planeCount(format.pixelFormat); ++plane) {
    const auto i = static_cast<std::size_t>(plane);
    const std::size_t row = rowBytes(format.pixelFormat, plane, format.size.width);
    const bool isHalf = format.pixelFormat == PixelFormat::kI420 && plane > 0;
    const std::size_t stride = strideBytes == 0 ? row : strideBytes / (isHalf ? 2 : 1);
    if (stride < row) return std::nullopt;
    layout.offsetBytes[i] = layout.bytes;
    layout.strideBytes[i] = stride;
    layout.bytes +=
        stride * static_cast<std::size_t>(planeRows(format.pixelFormat, plane, format.size.height));
  }
  return layout;
}

void FrameLayout::pack(const ImageView& picture, std::span<std::uint8_t> frame) const {
  assert(picture.format == format && picture.isComplete() && frame.size() >= bytes);
  for (int plane = 0; plane < planeCount(format.pixelFormat); ++plane) {
    const auto i = static_cast<std::size_t>(plane);
    for (int y = 0; y < planeRows(format.pixelFormat, plane, format.size.height); ++y) {
      const std::size_t begin = offsetBytes[i] + strideBytes[i] * static_cast<std::size_t>(y);
      std::ranges::copy(picture.row(plane, y), frame.subspan(begin).begin());
    }
  }
}

}  // namespace pleinair::hal::loopback
