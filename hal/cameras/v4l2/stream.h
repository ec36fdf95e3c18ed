#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "hal/cameras/v4l2/buffers.h"
#include "hal/cameras/v4l2/format.h"
#include "hal/clock.h"

namespace pleinair::hal::v4l2 {

/// A buffer that the driver has filled.
struct Filled {
  std::uint32_t index = 0;
  std::uint32_t flags = 0;  ///< V4L2_BUF_FLAG_…
  std::uint32_t sequence = 0;
  Duration timestamp{0};
  struct Plane {
    std::size_t offsetBytes = 0;  ///< of the pixels (data_offset)
    std::size_t usedBytes = 0;    ///< of pixels
  };
  std::array<Plane, 3> planes;
};

/// A device that streams into its buffers. One thread; leases are dropped on any. Ends with its
/// destruction; the device outlives it.
class Stream {
 public:
  /// Errors: as BufferSet::allocate, and kBusy, kIo of starting.
  static Result<std::unique_ptr<Stream>> start(const Device& device, const Negotiated& negotiated);
  ~Stream();
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  /// Gives the driver what the leases have given back. 0 or −errno.
  int queueReturned();
  /// 0 or −errno; −EAGAIN where none is full.
  int dequeue(Filled& filled);
  /// Gives a dequeued buffer back at once. 0 or −errno.
  int queue(std::uint32_t index);
  /// Lends a dequeued buffer: it goes back with queueReturned() once the lease has been dropped.
  std::shared_ptr<const void> lend(std::uint32_t index);

  const Buffer& buffer(std::uint32_t index) const { return *buffers_.at(index); }
  /// Whether the driver would have no buffer left if another dequeued one were lent.
  bool mustKeepTheNext() const { return lent_ + 1 >= buffers_.count(); }
  /// Whether frames are lost because of leases unless dequeue() comes in time: one buffer is left.
  bool isStarving() const { return lent_ > 0 && lent_ + 1 >= buffers_.count(); }
  bool hasEvents() const { return hasEvents_; }

 private:
  Stream(const Device& device, BufferSet buffers);

  const Device& device_;
  BufferSet buffers_;
  std::shared_ptr<Returns> returns_ = std::make_shared<Returns>();
  std::vector<std::uint32_t> returned_;  ///< scratch
  std::uint32_t lent_ = 0;
  bool hasEvents_ = false;
};

}  // namespace pleinair::hal::v4l2
