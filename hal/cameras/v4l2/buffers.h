#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "hal/cameras/v4l2/device.h"
#include "hal/file_descriptor.h"
#include "hal/frame_allocator.h"
#include "hal/frame_image.h"
#include "hal/v4l2/system_calls.h"

namespace pleinair::hal::v4l2 {

/// A mapping of a driver's buffer into the process; unmaps itself on any thread.
class Mapping {
 public:
  Mapping(SystemCalls& calls, void* address, std::size_t length)
      : calls_(&calls), address_(address), length_(length) {}
  Mapping(const Mapping&) = delete;
  Mapping& operator=(const Mapping&) = delete;
  Mapping(Mapping&& other) noexcept
      : calls_(other.calls_),
        address_(std::exchange(other.address_, nullptr)),
        length_(other.length_) {}
  Mapping& operator=(Mapping&&) = delete;
  ~Mapping() {
    if (address_ != nullptr) calls_->unmap(address_, length_);
  }

  std::span<const std::uint8_t> bytes() const {
    return {static_cast<const std::uint8_t*>(address_), length_};
  }

 private:
  SystemCalls* calls_;
  void* address_;
  std::size_t length_;
};

/// One memory plane of a buffer.
struct BufferPlane {
  Mapping mapping;
  FileDescriptor dmaBuf;  ///< unset where the driver exports none
};

/// The mappings of a buffer. They stay valid after the stream and its device are closed, until the
/// last lease is dropped: a mapping keeps the kernel's memory alive.
///
/// The processor's reads of lent memory are bracketed by DMA_BUF_IOCTL_SYNC, because it is the
/// dma-buf that is mapped. The driver's own (MMAP) is coherent between DQBUF and QBUF, since the
/// driver cleans and invalidates its caches (vb2's finish and prepare;
/// V4L2_MEMORY_FLAG_NON_COHERENT is not requested).
struct Buffer final : ReadAccess {
  explicit Buffer(SystemCalls& calls) : systemCalls(&calls) {}
  void beginRead() const override;
  void endRead() const override;
  /// Null for memory whose reads need no brackets.
  const ReadAccess* access() const { return isLent ? this : nullptr; }

  SystemCalls* systemCalls;
  std::vector<BufferPlane> planes;
  bool isLent = false;
};

/// The buffers of one stream, shared with the driver. The destructor frees them; leased ones live
/// on as orphans.
class BufferSet {
 public:
  /// Allocates, maps and exports the buffers. `neededBytes`: for each memory plane; 0 for JPEG.
  /// Errors: kBusy, kUnsupported (too few, or too small for the format), kIo.
  static Result<BufferSet> allocate(const Device& device,
                                    const std::vector<std::size_t>& neededBytes);
  /// Takes memory of the allocator, of `bytes` for each memory plane. Errors: kUnsupported (the
  /// driver takes no memory of others, or the allocator gives none), kBusy, kIo.
  static Result<BufferSet> borrow(const Device& device, FrameAllocator& allocator,
                                  const std::vector<std::size_t>& bytes);

  BufferSet(const BufferSet&) = delete;
  BufferSet& operator=(const BufferSet&) = delete;
  BufferSet(BufferSet&& other) noexcept
      : device_(std::exchange(other.device_, nullptr)),
        memory_(other.memory_),
        pool_(other.pool_),
        buffers_(std::move(other.buffers_)) {}
  BufferSet& operator=(BufferSet&&) = delete;
  ~BufferSet();

  std::uint32_t count() const { return static_cast<std::uint32_t>(buffers_.size()); }
  const std::shared_ptr<const Buffer>& at(std::uint32_t index) const { return buffers_.at(index); }
  /// V4L2_MEMORY_MMAP or V4L2_MEMORY_DMABUF.
  std::uint32_t memory() const { return memory_; }
  BufferIdentity identityOf(std::uint32_t index) const { return {.pool = pool_, .index = index}; }

 private:
  BufferSet(const Device& device, std::uint32_t memory)
      : device_(&device), memory_(memory), pool_(nextBufferPool()) {}

  const Device* device_;
  std::uint32_t memory_;
  std::uint64_t pool_;
  std::vector<std::shared_ptr<const Buffer>> buffers_;
};

}  // namespace pleinair::hal::v4l2
