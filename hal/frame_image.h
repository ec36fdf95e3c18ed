#pragma once

#include <array>
#include <cstdint>
#include <utility>

#include "hal/image.h"

namespace pleinair::hal {

/// Which buffer a frame lies in: a pool that a camera has allocated, and the place in it. It lasts
/// as long as the buffer does, so that what was imported from it is kept by it, never by a file
/// descriptor's number. No two pools of a process have the same number.
struct BufferIdentity {
  std::uint64_t pool = 0;  ///< 0: none; memory that no later frame comes in
  std::uint32_t index = 0;
  explicit operator bool() const { return pool != 0; }
  friend bool operator==(const BufferIdentity&, const BufferIdentity&) = default;
};

/// A number for a new pool. Any thread.
std::uint64_t nextBufferPool();

/// One image plane in a dma-buf, borrowed while the frame's lease is held.
struct DmaBufPlane {
  int fd = -1;  ///< −1: none
  std::size_t offsetBytes = 0;
  std::size_t strideBytes = 0;
};

/// What a driver needs around the processor's reads of a buffer: DMA_BUF_IOCTL_SYNC, which
/// invalidates caches. Any thread; calls may nest.
class ReadAccess {
 public:
  virtual void beginRead() const = 0;
  virtual void endRead() const = 0;

 protected:
  ~ReadAccess() = default;
};

/// The processor's access to the pixels of a frame, from FrameImage::map() until it is destroyed;
/// the frame's lease is held for longer. Move-only; any thread.
class FrameMapping {
 public:
  FrameMapping(const ImageView& pixels, const ReadAccess* access)
      : pixels_(pixels), access_(access) {
    if (access_ != nullptr) access_->beginRead();
  }
  FrameMapping(const FrameMapping&) = delete;
  FrameMapping& operator=(const FrameMapping&) = delete;
  FrameMapping(FrameMapping&& other) noexcept
      : pixels_(other.pixels_), access_(std::exchange(other.access_, nullptr)) {}
  FrameMapping& operator=(FrameMapping&&) = delete;
  ~FrameMapping() {
    if (access_ != nullptr) access_->endRead();
  }

  /// Valid while this lives.
  const ImageView& view() const { return pixels_; }

 private:
  ImageView pixels_;
  const ReadAccess* access_;
};

/// The picture of a frame. Its pixels are read on demand, between map() and the end of what that
/// gives, because a camera's memory may have to be synchronised, and may be uncached: reads of such
/// memory take 30 times as long. A value that refers to memory of the frame's lease.
class FrameImage {
 public:
  FrameImage() = default;
  /// A picture in ordinary memory.
  // NOLINTNEXTLINE(google-explicit-constructor): a view is a picture that is mapped already
  FrameImage(const ImageView& pixels) : format(pixels.format), pixels_(pixels) {}
  /// A picture in memory whose reads `access` brackets; null: none are needed.
  FrameImage(const ImageView& pixels, const ReadAccess* access)
      : format(pixels.format), pixels_(pixels), access_(access) {}

  FrameFormat format;

  /// Begins to read the pixels. Precondition: isComplete().
  FrameMapping map() const { return {pixels_, access_}; }
  /// Whether every plane is large enough for the format and its stride. Reads no pixels.
  bool isComplete() const { return pixels_.isComplete(); }
  /// Bytes from one row of a plane to the next, for the processor.
  std::size_t strideBytes(int plane) const {
    return pixels_.planes.at(static_cast<std::size_t>(plane)).strideBytes;
  }
  /// Whether reads have to be bracketed: the memory is not the processor's alone.
  bool needsAccess() const { return access_ != nullptr; }

 private:
  ImageView pixels_;
  const ReadAccess* access_ = nullptr;
};

}  // namespace pleinair::hal
