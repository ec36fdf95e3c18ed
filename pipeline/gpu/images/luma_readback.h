#pragma once

#include <array>
#include <span>

#include "hal/clock.h"
#include "hal/error.h"
#include "hal/image.h"
#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/gpu_loss.h"
#include "pipeline/gpu/handle.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/texture.h"

namespace pleinair::gpu {

/// Reads the luma of imported camera frames back to memory, where the processor is slow to read the
/// frames' own: a pass packs it, and a fence says when it has been copied. The bytes are those that
/// tracking::LumaConverter gives of the same frame. Paint thread only.
class LumaReadback {
 public:
  explicit LumaReadback(const ShaderLibrary& library, GpuTestHook testHook = {});

  /// Whether it knows the layout: all but mosaics, which the processor interpolates.
  static bool canRead(hal::PixelFormat format) { return !hal::isBayer(format); }

  /// Begins to read a frame, whose planes are textures as importedPlane() has them; one that is
  /// still in flight is dropped. Allocates for another size only. Precondition: canRead().
  void begin(const hal::FrameFormat& format, std::span<const Texture> planes);
  /// Copies the frame's luma into `luma`, which becomes kGrey8 of its size. No where it has not
  /// been copied after `limit` of real time. Error: kDeviceLost. Precondition: begun.
  hal::Answer finish(hal::Image& luma, hal::Duration limit);

 private:
  Program& programOf(hal::PixelFormat format);
  void prepare(hal::FrameSize size);

  GpuTestHook testHook_;
  std::array<Program, 4> programs_;
  hal::FrameSize size_;
  Texture packed_;
  RenderTarget target_;
  Buffer buffer_;
  Fence copied_;
};

}  // namespace pleinair::gpu
