#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "hal/cameras/v4l2/device.h"
#include "hal/file_descriptor.h"
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
///
/// No sync calls bracket the CPU's reads: an MMAP buffer is coherent for the CPU between DQBUF and
/// QBUF, since the driver cleans and invalidates its caches (vb2's finish and prepare;
/// V4L2_MEMORY_FLAG_NON_COHERENT is not requested). DMA_BUF_IOCTL_SYNC is for users who map the
/// exported dma-buf.
struct BufferPlane {
  Mapping mapping;
  FileDescriptor dmaBuf;  ///< unset where the driver exports none
};

/// The mappings of a buffer. They stay valid after the stream and its device are closed, until the
/// last lease is dropped: a mapping keeps the kernel's memory alive.
struct Buffer {
  std::vector<BufferPlane> planes;
};

/// Indices of buffers whose leases have been dropped. They return to the camera's thread, the only
/// one that may queue them in the driver. Thread-safe.
class Returns {
 public:
  void put(std::uint32_t index) {
    const std::scoped_lock lock(mutex_);
    indices_.push_back(index);
  }
  /// Moves the returned indices into `into`, which must be empty and keeps its memory.
  void take(std::vector<std::uint32_t>& into) {
    const std::scoped_lock lock(mutex_);
    std::swap(indices_, into);
  }

 private:
  std::mutex mutex_;
  std::vector<std::uint32_t> indices_;
};

/// The buffers of one stream, shared with the driver. The destructor frees them; leased ones live
/// on as orphans.
class BufferSet {
 public:
  /// Allocates, maps and exports the buffers. `neededBytes`: for each memory plane; 0 for JPEG.
  /// Errors: kBusy, kUnsupported (too few, or too small for the format), kIo.
  static Result<BufferSet> allocate(const Device& device,
                                    const std::vector<std::size_t>& neededBytes);

  BufferSet(const BufferSet&) = delete;
  BufferSet& operator=(const BufferSet&) = delete;
  BufferSet(BufferSet&& other) noexcept
      : device_(std::exchange(other.device_, nullptr)), buffers_(std::move(other.buffers_)) {}
  BufferSet& operator=(BufferSet&&) = delete;
  ~BufferSet();

  std::uint32_t count() const { return static_cast<std::uint32_t>(buffers_.size()); }
  const std::shared_ptr<const Buffer>& at(std::uint32_t index) const { return buffers_.at(index); }

 private:
  explicit BufferSet(const Device& device) : device_(&device) {}

  const Device* device_;
  std::vector<std::shared_ptr<const Buffer>> buffers_;
};

}  // namespace pleinair::hal::v4l2
