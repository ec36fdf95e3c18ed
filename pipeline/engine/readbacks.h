#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "hal/captured_frame.h"
#include "pipeline/engine/painter.h"
#include "pipeline/present/readback.h"

namespace pleinair {

/// The rings that read a Painter's pictures into memory, each with the frames that its pictures
/// in flight are of. On the thread of the GL context.
class Readbacks {
 public:
  /// Opens one that is warmed up for pictures of these sizes, and gives its number. Throws as
  /// present::Readback().
  int open(const gpu::ShaderLibrary& library, const hal::FrameFormat& format,
           const std::vector<hal::FrameSize>& sizes, const gpu::GpuTestHook& testHook);

  /// Lets each that has room read the picture of this frame, whose full size it may be a smaller
  /// version of; the others skip it.
  void submit(const gpu::Texture& picture, hal::FrameSize fullSize,
              const hal::CapturedFrame& frame);
  /// As Painter::take().
  hal::Result<bool> take(int number, OutputFrame& picture, bool wait);

  bool hasRoom(int number) const { return at(number).ring.hasRoom(); }
  std::uint64_t skipped(int number) const { return at(number).skipped; }

 private:
  struct Stamp {
    std::uint64_t sequence = 0;
    hal::TimePoint captureTime;
  };
  struct Reader {
    explicit Reader(present::Readback reader) : ring(std::move(reader)) {}
    present::Readback ring;
    std::vector<Stamp> inFlight;  ///< oldest first
    std::uint64_t skipped = 0;
  };
  Reader& at(int number) { return *readers_.at(static_cast<std::size_t>(number)); }
  const Reader& at(int number) const { return *readers_.at(static_cast<std::size_t>(number)); }

  std::vector<std::unique_ptr<Reader>> readers_;
};

}  // namespace pleinair
