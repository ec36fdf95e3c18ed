#pragma once

#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

namespace pleinair::hal {

/// Indices of buffers whose leases have been dropped. They return to the camera's thread, the only
/// one that may queue them in the driver. Thread-safe.
class ReturnedBuffers {
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

}  // namespace pleinair::hal
