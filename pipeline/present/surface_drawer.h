#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "hal/clock.h"
#include "hal/surface.h"
#include "pipeline/gpu/frames/imported_texture.h"
#include "pipeline/gpu/handle.h"
#include "pipeline/gpu/images/resampler.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/texture.h"

namespace pleinair::present {

/// Draws painted pictures straight into the surfaces that an output lends: scaled, turned, and with
/// black where the buffer is larger; the same pixels to the bit as a Readback and a copy give.
/// Paint thread only.
class SurfaceDrawer {
 public:
  /// `library` has presentShaders() and gpuShaders(); `size`: of the turned picture.
  SurfaceDrawer(const gpu::ShaderLibrary& library, hal::FrameSize size, int quarterTurns,
                gpu::GpuTestHook testHook = {});

  /// Takes these surfaces in place of earlier ones, draws a picture of each of these sizes, so that
  /// programs are compiled, and then the pattern (hal::surfacePatternAt()) into each, and waits.
  /// Throws hal::Failure (kUnsupported, kDeviceLost).
  void import(std::span<const hal::GpuSurface> surfaces,
              std::span<const hal::FrameSize> pictureSizes);

  /// Begins to draw `picture` (RGBA8, LINEAR), laid onto the format's size as one of `fullSize` is.
  /// Precondition: the surface was imported.
  void submit(const gpu::Texture& picture, hal::FrameSize fullSize, hal::SurfaceId surface);
  bool isEmpty() const { return inFlight_.empty(); }
  /// Whether the oldest that is in flight is complete, after waiting `limit` of real time at most.
  /// Error: kDeviceLost. Precondition: !isEmpty().
  hal::Answer isReadyWithin(hal::Duration limit) const;
  /// The oldest is in flight no more. Precondition: !isEmpty().
  void pop();

 private:
  struct Imported {
    hal::SurfaceId id{};
    gpu::Texture texture;
    gpu::RenderTarget target;
    glm::ivec2 origin{};
  };
  void draw(const gpu::Texture& picture, hal::FrameSize fullSize, const Imported& into);

  hal::FrameSize size_;
  int quarterTurns_;
  gpu::GpuTestHook testHook_;
  gpu::Program program_;
  gpu::Program pattern_;
  gpu::Resampler resampler_;
  std::vector<Imported> imported_;
  std::vector<gpu::Fence> inFlight_;  ///< oldest first
};

}  // namespace pleinair::present
