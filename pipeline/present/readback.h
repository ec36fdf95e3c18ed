#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "hal/clock.h"
#include "hal/image.h"
#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/handle.h"
#include "pipeline/gpu/images/resampler.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/texture.h"

namespace pleinair::present {

/// Brings painted pictures to memory in an output's format without stalling the GPU: scaled and
/// converted by a pass, copied into a ring of buffers, and handed out when a fence says so. Paint
/// thread only.
class Readback {
 public:
  /// `library` has presentShaders(); `format`: RGBA8, RGB8, grey, I420, NV12 or YUYV; `depth`: how
  /// many pictures may be in flight; `quarterTurns`: by how many right angles pictures are turned
  /// clockwise, of RGBA8 only, whose size is the turned one.
  Readback(const gpu::ShaderLibrary& library, hal::FrameFormat format, int depth = 3,
           gpu::GpuTestHook testHook = {}, int quarterTurns = 0);

  /// The size of the texture that a picture of this format is packed into. A read-back cannot be
  /// made if it exceeds the device's limit.
  static hal::FrameSize packedSize(const hal::FrameFormat& format);

  /// Reads one picture of this size, undefined, and drops it: what pictures need is compiled and
  /// allocated then. Throws hal::Failure (kDeviceLost). Precondition: isEmpty().
  void warmUp(hal::FrameSize pictureSize);

  const hal::FrameFormat& format() const { return format_; }
  bool hasRoom() const { return submitted_ - taken_ < ring_.size(); }
  bool isEmpty() const { return submitted_ == taken_; }

  /// Begins to read `picture` (RGBA8, LINEAR), laid onto the format's size as one of `fullSize` is,
  /// which it may be a smaller version of. Precondition: hasRoom().
  void submit(const gpu::Texture& picture, hal::FrameSize fullSize);
  void submit(const gpu::Texture& picture) { submit(picture, picture.size()); }

  /// Copies the oldest picture into `image`, which gets this read-back's format; pictures come in
  /// the order in which they were submitted. False if none is ready. Error: kDeviceLost; no picture
  /// comes any more.
  hal::Answer poll(hal::Image& image);
  /// The same, but waits for the oldest picture: false only if none is in flight.
  hal::Answer wait(hal::Image& image);
  /// Whether the oldest picture is ready, after waiting for it `limit` of real time at most. Error:
  /// kDeviceLost. Precondition: !isEmpty().
  hal::Answer isReadyWithin(hal::Duration limit) const;

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
  hal::Answer copyOldest(hal::Image& image);
  void unpack(const std::uint8_t* bytes, hal::Image& image) const;

  hal::FrameSize unturnedSize() const;

  hal::FrameFormat format_;
  int quarterTurns_ = 0;
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
