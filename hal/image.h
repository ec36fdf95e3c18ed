#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hal/pixel_format.h"

namespace pleinair::hal {

/// One plane of an image in memory. `bytes` covers at least stride × (rows − 1) + one packed row.
struct PlaneView {
  std::span<const std::uint8_t> bytes;
  std::size_t strideBytes = 0;
};

/// An image in memory that another object owns. Never assume a packed stride.
struct ImageView {
  FrameFormat format;
  std::array<PlaneView, 3> planes;  ///< the first planeCount(format.pixelFormat) are set

  /// Row `y` of plane `plane`: rowBytes(...) bytes.
  std::span<const std::uint8_t> row(int plane, int y) const;
  /// Whether every plane is large enough for the format and its stride.
  bool isComplete() const;
};

class FrameImage;

/// An image that owns its memory, with packed rows.
class Image {
 public:
  Image() = default;
  /// Zeroed planes of `format`. Precondition: isAcceptedSize(format.size).
  explicit Image(FrameFormat format);
  /// A packed copy.
  explicit Image(const ImageView& view);
  /// A packed copy of a camera's picture, which is mapped for it.
  explicit Image(const FrameImage& picture);

  const FrameFormat& format() const { return format_; }
  FrameSize size() const { return format_.size; }
  std::span<std::uint8_t> plane(int index);
  std::span<std::uint8_t> row(int plane, int y);
  /// Valid while this Image lives and is not assigned to.
  ImageView view() const;

 private:
  FrameFormat format_;
  std::array<std::vector<std::uint8_t>, 3> planes_;
};

/// The luma plane of an image, as a view, if the format stores one (grey, NV12, I420); else
/// nothing. A Bayer mosaic gives nothing.
std::optional<PlaneView> lumaPlane(const ImageView& image);

}  // namespace pleinair::hal
