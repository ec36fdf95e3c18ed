#pragma once

#include <cstdint>
#include <map>
#include <span>

#include "hal/outputs/display/card.h"
#include "hal/pixel_format.h"

namespace pleinair::support {

/// The framebuffers of a fake card, in memory of files as dma-bufs are; XRGB8888, rows padded.
class FakeFramebuffers {
 public:
  struct Framebuffer {
    hal::display::ScanOutBuffer buffer;
    hal::FrameSize size;
    bool isGpu = false;
  };

  /// @param rowPadding bytes after each row
  /// @param memoryBytes of all of them; more is ENOMEM
  /// @param exportsDmaBufs whether their files are told
  FakeFramebuffers(std::size_t rowPadding, std::size_t memoryBytes, bool exportsDmaBufs)
      : rowPadding_(rowPadding), memoryBytes_(memoryBytes), exportsDmaBufs_(exportsDmaBufs) {}
  ~FakeFramebuffers();  ///< all are destroyed by then
  FakeFramebuffers(const FakeFramebuffers&) = delete;
  FakeFramebuffers& operator=(const FakeFramebuffers&) = delete;

  /// Returns 0 or -errno, as the card's calls do.
  /// @param id of the framebuffer; its handle's is the next
  int create(hal::display::ObjectId id, hal::FrameSize size, bool isGpu,
             hal::display::ScanOutBuffer& buffer);
  void destroy(hal::display::ObjectId id);

  bool has(hal::display::ObjectId id) const { return all_.contains(id); }
  const Framebuffer& at(hal::display::ObjectId id) const { return all_.at(id); }

  /// Its bytes, little-endian.
  std::uint32_t pixel(hal::display::ObjectId id, int x, int y) const;
  /// The pixels of the upper left part of `size`, without the rows' padding.
  void read(hal::display::ObjectId id, hal::FrameSize size, std::span<std::uint8_t> pixels) const;

 private:
  std::size_t rowPadding_;
  std::size_t memoryBytes_;
  bool exportsDmaBufs_;
  std::size_t usedBytes_ = 0;
  std::map<hal::display::ObjectId, Framebuffer> all_;
};

}  // namespace pleinair::support
