#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include <sys/mman.h>

namespace pleinair::hal {

/// Memory of a file or dma-buf, shared and mapped into this process until this goes. Move-only.
class MappedMemory {
 public:
  /// Maps the first `bytes` of it for reads, and for writes where `isWritable`. Holds nothing where
  /// that fails, with errno.
  static MappedMemory map(int fd, std::size_t bytes, bool isWritable = false) {
    void* const address =
        ::mmap(nullptr, bytes, PROT_READ | (isWritable ? PROT_WRITE : 0), MAP_SHARED, fd, 0);
    MappedMemory memory;
    if (address != MAP_FAILED) memory.bytes_ = {static_cast<std::uint8_t*>(address), bytes};
    return memory;
  }
  MappedMemory() = default;
  MappedMemory(const MappedMemory&) = delete;
  MappedMemory& operator=(const MappedMemory&) = delete;
  MappedMemory(MappedMemory&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}
  MappedMemory& operator=(MappedMemory&& other) noexcept {
    std::swap(bytes_, other.bytes_);
    return *this;
  }
  ~MappedMemory() {
    if (!bytes_.empty()) ::munmap(bytes_.data(), bytes_.size());
  }

  explicit operator bool() const { return !bytes_.empty(); }
  /// Written only where they were mapped for that.
  std::span<std::uint8_t> bytes() const { return bytes_; }

 private:
  std::span<std::uint8_t> bytes_;
};

}  // namespace pleinair::hal
