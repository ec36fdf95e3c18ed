#pragma once

#include <cstddef>
#include <string>

#include "hal/error.h"
#include "hal/file_descriptor.h"

namespace pleinair::hal {

/// Memory that the consumer of frames lends to a camera, so that both it and the camera reach it:
/// dma-bufs from a heap, from udmabuf, or of a graphics card. One thread at a time.
class FrameAllocator {
 public:
  virtual ~FrameAllocator() = default;
  FrameAllocator() = default;
  FrameAllocator(const FrameAllocator&) = delete;
  FrameAllocator& operator=(const FrameAllocator&) = delete;

  /// "vgem", "heap system".
  virtual std::string name() const = 0;
  /// A dma-buf of at least `bytes`, which a process can map. Errors: kUnsupported, kIo.
  virtual Result<FileDescriptor> allocate(std::size_t bytes) = 0;
};

}  // namespace pleinair::hal
