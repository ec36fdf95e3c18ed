#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "hal/buffer_leases.h"
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
    std::size_t offsetBytes = 0;  ///< where the pixels begin (data_offset)
    std::size_t usedBytes = 0;    ///< bytes of pixels
  };
  std::array<Plane, 3> planes;
};

/// A device that streams into its buffers. One thread; leases may be dropped on any. The destructor
/// ends the stream; the device must outlive it.
class Stream {
 public:
  /// Streams into the allocator's memory, or the device's own where that is null. Errors: as
  /// BufferSet::allocate and borrow; kBusy and kIo if streaming cannot start.
  static Result<std::unique_ptr<Stream>> start(const Device& device, const Negotiated& negotiated,
                                               FrameAllocator* allocator = nullptr);
  ~Stream();
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  /// Queues the buffers that the dropped leases have returned. 0 or −errno.
  int queueReturned();
  /// Takes a filled buffer. 0 or −errno; −EAGAIN if there is none.
  int dequeue(Filled& filled);
  /// Queues a dequeued buffer again at once. 0 or −errno.
  int queue(std::uint32_t index);
  /// Lends a dequeued buffer. queueReturned() queues it once the lease has been dropped.
  std::shared_ptr<const void> lend(std::uint32_t index);

  const Buffer& buffer(std::uint32_t index) const { return *buffers_.at(index); }
  BufferIdentity identityOf(std::uint32_t index) const { return buffers_.identityOf(index); }
  /// Whether its buffers have dma-bufs, of the driver's or of others.
  bool hasDmaBufs() const { return static_cast<bool>(buffers_.at(0)->planes.at(0).dmaBuf); }
  /// Whether lending one more dequeued buffer would leave the driver with none.
  bool mustKeepTheNext() const { return leases_.count() + 1 >= buffers_.count(); }
  /// Whether leases will cause an underrun unless dequeue() comes in time: the driver has one
  /// buffer left.
  bool isStarving() const { return leases_.count() > 0 && leases_.count() + 1 >= buffers_.count(); }
  bool hasEvents() const { return hasEvents_; }

 private:
  Stream(const Device& device, BufferSet buffers);

  const Device& device_;
  BufferSet buffers_;
  BufferLeases leases_;
  bool hasEvents_ = false;
};

}  // namespace pleinair::hal::v4l2
