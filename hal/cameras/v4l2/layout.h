#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hal/pixel_format.h"

namespace pleinair::hal::v4l2 {

/// The memory layout of one of the kernel's pixel formats.
struct Layout {
  std::uint32_t fourcc = 0;
  PixelFormat pixelFormat = PixelFormat::kYuyv;  ///< of the frames; for JPEG, after decoding
  int memoryPlanes = 1;  ///< buffers per frame; several image planes may share one
  bool isJpeg = false;
};

/// The supported formats, the one that is cheapest to paint first.
std::span<const Layout> layouts();
const Layout* findLayout(std::uint32_t fourcc);

/// The place of an image plane in memory.
struct PlanePlace {
  int memoryPlane = 0;
  std::size_t offsetBytes = 0;
  std::size_t strideBytes = 0;
  std::size_t sizeBytes = 0;  ///< stride × (rows − 1) + one packed row
};

/// The places of an uncompressed image's planes, for the given strides of its memory planes
/// (bytesperline; 0: unknown, so that rows are packed). Planes that share a memory plane follow
/// each other; the chroma stride is then the luma stride, or half of it if chroma is not
/// interleaved, as V4L2's "YUV formats" prescribes.
std::array<PlanePlace, 3> planePlaces(const Layout& layout, FrameSize size,
                                      std::array<std::size_t, 3> memoryStrides);

/// The bytes that memory plane `index` must hold.
std::size_t neededBytes(const std::array<PlanePlace, 3>& places, PixelFormat format, int index);

}  // namespace pleinair::hal::v4l2
