#include "hal/image.h"

#include <algorithm>
#include <cassert>

namespace pleinair::hal {
namespace {

std::size_t index(int value) {
  return static_cast<std::size_t>(value);
}

}  // namespace

std::span<const std::uint8_t> ImageView::row(int plane, int y) const {
  const PlaneView& view = planes[index(plane)];
  return view.bytes.subspan(index(y) * view.strideBytes,
                            rowBytes(format.pixelFormat, plane, format.size.width));
}

bool ImageView::isComplete() const {
  if (!isAcceptedSize(format.size)) return false;
  for (int plane = 0; plane < planeCount(format.pixelFormat); ++plane) {
    const PlaneView& view = planes[index(plane)];
    const std::size_t row = rowBytes(format.pixelFormat, plane, format.size.width);
    const std::size_t rows = index(planeRows(format.pixelFormat, plane, format.size.height));
    if (view.strideBytes < row || (rows > 1 && view.strideBytes > view.bytes.size()) ||
        view.bytes.size() < view.strideBytes * (rows - 1) + row) {
      return false;
    }
  }
  return true;
}

Image::Image(FrameFormat format) : format_(format) {
  assert(isAcceptedSize(format.size));
  for (int plane = 0; plane < planeCount(format.pixelFormat); ++plane) {
    planes_[index(plane)].resize(rowBytes(format.pixelFormat, plane, format.size.width) *
                                 index(planeRows(format.pixelFormat, plane, format.size.height)));
  }
}

Image::Image(const ImageView& view) : Image(view.format) {
  for (int plane = 0; plane < planeCount(format_.pixelFormat); ++plane) {
    for (int y = 0; y < planeRows(format_.pixelFormat, plane, format_.size.height); ++y) {
      std::ranges::copy(view.row(plane, y), row(plane, y).begin());
    }
  }
}

std::span<std::uint8_t> Image::plane(int planeIndex) {
  return planes_[index(planeIndex)];
}

std::span<std::uint8_t> Image::row(int plane, int y) {
  const std::size_t bytes = rowBytes(format_.pixelFormat, plane, format_.size.width);
  return this->plane(plane).subspan(index(y) * bytes, bytes);
}

ImageView Image::view() const {
  ImageView view{.format = format_, .planes = {}};
  for (int plane = 0; plane < planeCount(format_.pixelFormat); ++plane) {
    view.planes[index(plane)] = {
        .bytes = planes_[index(plane)],
        .strideBytes = rowBytes(format_.pixelFormat, plane, format_.size.width)};
  }
  return view;
}

std::optional<PlaneView> lumaPlane(const ImageView& image) {
  switch (image.format.pixelFormat) {
    case PixelFormat::kGrey8:
    case PixelFormat::kNv12:
    case PixelFormat::kI420:
      return image.planes[0];
    default:
      return std::nullopt;
  }
}

}  // namespace pleinair::hal
