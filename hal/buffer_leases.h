#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace pleinair::hal {

/// The buffers of a stream that frames lend. A buffer whose last lease has been dropped returns to
/// the camera's thread, the only one that may queue it in the driver. That thread calls all of
/// this; leases are dropped on any, also after the end of this.
class BufferLeases {
 public:
  /// How many leases there are whose buffers have not been taken back.
  std::size_t count() const { return lent_; }

  /// Lends a buffer. `memory` is kept until the last copy of the lease is dropped.
  std::shared_ptr<const void> lend(std::uint32_t index, std::shared_ptr<const void> memory) {
    ++lent_;
    return std::make_shared<const Lease>(std::move(memory), returned_, index);
  }

  /// Calls `queue` with the index of each buffer that has come back since the last call.
  template <class Queue>
  void takeBack(Queue queue) {
    taken_.clear();
    returned_->take(taken_);
    lent_ -= taken_.size();
    for (const std::uint32_t index : taken_) queue(index);
  }

 private:
  class Returned {
   public:
    void put(std::uint32_t index) {
      const std::scoped_lock lock(mutex_);
      indices_.push_back(index);
    }
    /// `into` is empty, and keeps its memory for the next time.
    void take(std::vector<std::uint32_t>& into) {
      const std::scoped_lock lock(mutex_);
      std::swap(indices_, into);
    }

   private:
    std::mutex mutex_;
    std::vector<std::uint32_t> indices_;
  };

  class Lease {
   public:
    Lease(std::shared_ptr<const void> memory, std::shared_ptr<Returned> returned,
          std::uint32_t index)
        : memory_(std::move(memory)), returned_(std::move(returned)), index_(index) {}
    ~Lease() { returned_->put(index_); }
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;

   private:
    std::shared_ptr<const void> memory_;
    std::shared_ptr<Returned> returned_;
    std::uint32_t index_;
  };

  std::shared_ptr<Returned> returned_ = std::make_shared<Returned>();
  std::vector<std::uint32_t> taken_;  ///< scratch
  std::size_t lent_ = 0;
};

}  // namespace pleinair::hal
