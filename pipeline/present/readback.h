#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "hal/clock.h"
#include "hal/image.h"
#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/handle.h"
#include "pipeline/gpu/program.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/resampler.h"
#include "pipeline/gpu/shader_library.h"
#include "pipeline/gpu/texture.h"

namespace pleinair::present {

/// What Readback::take() came to.
enum class ReadbackResult { kNoImage, kImage };

/// Brings painted pictures to memory in an output's format without stalling the GPU: scaled and
/// converted by a pass, copied into a ring of buffers, and handed out when a fence says so. Paint
/// thread only.
class Readback {
 public:
  /// `library` has presentShaders(). `format`: RGBA8, RGB8, grey, I420, NV12 or YUYV. `depth`:
  /// largest number of images in flight.
  Readback(const gpu::ShaderLibrary& library, hal::FrameFormat format, int depth = 3,
           gpu::GpuTestHook testHook = {});

  /// Size of the texture that an image of this format passes through. Above the device's limit, no
  /// reader can be made.
  static hal::FrameSize packedSize(const hal::FrameFormat& format);

  /// Reads and drops one image of this size with undefined contents, so that everything is compiled
  /// and allocated. Throws hal::Failure (kDeviceLost). Precondition: isEmpty().
  void warmUp(hal::FrameSize pictureSize);

  const hal::FrameFormat& format() const { return format_; }
  bool hasRoom() const { return submitted_ - taken_ < ring_.size(); }
  bool isEmpty() const { return submitted_ == taken_; }

  /// Begins to read `picture` (RGBA8, LINEAR), which may be a reduced version of an image of
  /// `fullSize`; it is scaled to the format's size as that image would be. Precondition: hasRoom().
  void submit(const gpu::Texture& picture, hal::FrameSize fullSize);
  void submit(const gpu::Texture& picture) { submit(picture, picture.size()); }

  /// Copies the oldest picture into `image`, which gets this reader's format; pictures come in the
  /// order they were submitted. kNoImage if none is ready; with `wait` only if none is in flight.
  /// Error: kDeviceLost; no picture comes any more.
  hal::Result<ReadbackResult> take(hal::Image& image, bool wait);

 private:
  struct Slot {
    gpu::Buffer buffer;
    gpu::Fence copied;
  };
  /// Packs one plane into its area of the target.
  struct PlanePass {
    gpu::Program program;
    glm::ivec2 origin;
    hal::FrameSize texels;
  };
  void pack(const gpu::Texture& picture);
  hal::Result<bool> copyOldest(hal::Image& image);
  void unpack(const std::uint8_t* bytes, hal::Image& image) const;

  hal::FrameFormat format_;
  gpu::GpuTestHook testHook_;
  std::vector<PlanePass> passes_;
  gpu::Resampler resampler_;
  gpu::Texture packed_;
  gpu::RenderTarget target_;
  std::vector<Slot> ring_;
  std::size_t submitted_ = 0;
  std::size_t taken_ = 0;
};

}  // namespace pleinair::present
