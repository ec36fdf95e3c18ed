#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "hal/cameras/libcamera/library.h"
#include "hal/error.h"
#include "hal/frame_image.h"

namespace pleinair::hal::libcamera {

/// A plane of a buffer: bytes of a dma-buf, which several planes may share.
struct BufferPlane {
  int fd = -1;  ///< borrowed
  std::size_t offset = 0, length = 0;
};

/// Maps the dma-bufs of a buffer for the CPU's reads, each once, and keeps descriptors of its own,
/// because frames outlive the buffers of libcamera. Any thread once it is made.
class MappedBuffer final : public ReadAccess {
 public:
  /// Takes three planes at most. Planes beyond the end of their dma-buf are shortened. Errors:
  /// kIo and others of mmap().
  static Result<std::shared_ptr<MappedBuffer>> map(std::span<const BufferPlane> planes);
  MappedBuffer() { memory.access = this; }
  ~MappedBuffer();
  MappedBuffer(const MappedBuffer&) = delete;
  MappedBuffer& operator=(const MappedBuffer&) = delete;

  void beginRead() const override;
  void endRead() const override;

  BufferMemory memory;

 private:
  /// Memory that is no dma-buf needs none.
  void sync(std::uint64_t flag) const;
  std::span<const std::uint8_t> view(int fd);

  std::map<int, std::span<const std::uint8_t>> mappings_;
  std::map<int, int> descriptors_;
};

}  // namespace pleinair::hal::libcamera
