#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "hal/cameras/libcamera/library.h"
#include "hal/dma_buf_sync.h"
#include "hal/error.h"
#include "hal/file_descriptor.h"
#include "hal/frame_image.h"
#include "hal/mapped_memory.h"

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
  MappedBuffer(const MappedBuffer&) = delete;
  MappedBuffer& operator=(const MappedBuffer&) = delete;

  void beginRead() const override;
  void endRead() const override;

  BufferMemory memory;

 private:
  /// A dma-buf, by a descriptor of this one's own.
  struct Shared {
    FileDescriptor descriptor;
    MappedMemory memory;
  };
  void sync(DmaBufAccess access) const;
  /// What a borrowed descriptor refers to, mapped at first; null with errno where it cannot be.
  const Shared* shared(int fd);

  std::map<int, Shared> shared_;  ///< by the borrowed descriptors
};

}  // namespace pleinair::hal::libcamera
