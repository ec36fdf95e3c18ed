#pragma once

#include <cassert>
#include <cstdint>
#include <cstring>

#include <sys/mman.h>

#include "hal/surface.h"
#include "hal/surface_pattern.h"

namespace pleinair::support {

/// Stands for a GPU that draws into a surface's memory, by its descriptor: `pixelAt(x, y)` gives a
/// pixel's bytes B, G, R, X, little-endian.
template <class PixelAt>
void drawInto(const hal::GpuSurface& surface, PixelAt pixelAt) {
  const hal::SurfacePlane& plane = surface.surface.planes[0];
  const hal::FrameSize size = surface.bufferSize;
  const std::size_t bytes = plane.strideBytes * static_cast<std::size_t>(size.height);
  void* memory = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, plane.dmaBuf, 0);
  assert(memory != MAP_FAILED);
  auto* row = static_cast<std::uint8_t*>(memory);
  for (int y = 0; y < size.height; ++y, row += plane.strideBytes) {
    for (int x = 0; x < size.width; ++x) {
      const std::uint32_t pixel = pixelAt(x, y);
      std::memcpy(row + static_cast<std::size_t>(x) * sizeof(pixel), &pixel, sizeof(pixel));
    }
  }
  ::munmap(memory, bytes);
}

inline void drawPatternInto(const hal::GpuSurface& surface) {
  drawInto(surface, [&](int x, int y) {
    const auto rgb = hal::surfacePatternAt(x, y, surface.surface.id);
    return std::uint32_t{rgb[0]} << 16U | std::uint32_t{rgb[1]} << 8U | rgb[2];
  });
}

}  // namespace pleinair::support
