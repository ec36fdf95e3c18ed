#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hal/pixel_format.h"

namespace pleinair::hal::v4l2 {

/// How one of the kernel's pixel formats lies in memory.
struct Layout {
  std::uint32_t fourcc = 0;
  PixelFormat pixelFormat = PixelFormat::kYuyv;  ///< of the frames; of JPEGs, once decoded
  int memoryPlanes = 1;  ///< buffers a frame; the planes of a picture may share one
  bool isJpeg = false;
};

/// What is read, what costs least to paint first.
std::span<const Layout> layouts();
const Layout* findLayout(std::uint32_t fourcc);

/// Where a plane of a picture lies.
struct PlanePlace {
  int memoryPlane = 0;
  std::size_t offsetBytes = 0;
  std::size_t strideBytes = 0;
  std::size_t sizeBytes = 0;  ///< stride × (rows − 1) + one packed row
};

/// The planes of an uncompressed picture whose memory planes have these strides (bytesperline; 0:
/// the driver does not say, so that rows are packed). Planes that share a memory plane follow each
/// other; chroma's stride is then luma's, or half of it where it is not interleaved, as V4L2's
/// "YUV formats" prescribes.
std::array<PlanePlace, 3> planePlaces(const Layout& layout, FrameSize size,
                                      std::array<std::size_t, 3> memoryStrides);

/// The bytes that memory plane `index` must hold.
std::size_t neededBytes(const std::array<PlanePlace, 3>& places, PixelFormat format, int index);

}  // namespace pleinair::hal::v4l2
