#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "hal/image.h"
#include "hal/pixel_format.h"

namespace pleinair::hal::loopback {

/// Where the planes of one picture lie in the bytes that a single-planar V4L2 device takes: one
/// after the other; chroma of NV12 has luma's stride, Cb and Cr of I420 half of it (linux/
/// videodev2.h on bytesperline).
struct FrameLayout {
  FrameFormat format;
  std::array<std::size_t, 3> offsetBytes{};
  std::array<std::size_t, 3> strideBytes{};
  std::size_t bytes = 0;  ///< of the whole

  /// `strideBytes` of the first plane; 0: packed. Nothing where a row does not fit into its stride.
  static std::optional<FrameLayout> of(const FrameFormat& format, std::size_t strideBytes);

  /// Copies the picture's rows to their places; what is between them stays as it is. Preconditions:
  /// the picture has this format, and `frame` at least `bytes`.
  void pack(const ImageView& picture, std::span<std::uint8_t> frame) const;
};

}  // namespace pleinair::hal::loopback
