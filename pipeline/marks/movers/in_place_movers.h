#pragma once

#include <array>
#include <cstddef>

#include "hal/pixel_format.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/marks/motion_field.h"
#include "pipeline/marks/movers/busy_blocks.h"
#include "pipeline/scene/render/ar_frame.h"

namespace pleinair::marks {

/// The plain parts of people who stay where they are and move there: faces, hair, clothes. They
/// look as what MotionLayers remembers of these places, but before a camera that stands their
/// motion, added up over time, shows that they are no background. All calls on the thread of the
/// GL context that was current at construction.
class InPlaceMovers {
 public:
  /// `blocks` is the number of blocks of MotionLayers. Throws hal::Failure if GPU memory runs out.
  InPlaceMovers(const gpu::ShaderLibrary& library, hal::FrameSize blocks);

  /// The state of the camera. Motion is added up while it stands. Once it moves, the sum is kept for
  /// a moment, so that a nudge loses nothing, and then forgotten.
  struct Camera {
    bool stands = false;    ///< since the previous frame
    bool hasStood = false;  ///< until lately
  };
  /// Adds a frame, whose cells have been compared, and marks the blocks that have moved as busy.
  void follow(const scene::ArFrame& frame, const MotionField& field, const gpu::Texture& candidates,
              const gpu::Texture& activity, const BusyBlocks& blocks, Camera camera,
              float stepSeconds);

  /// The displacements of blocks in the last frame (shaders/mover_displacement.glsl): RGBA16F, a
  /// texel for each block.
  const gpu::Texture& displacements() const { return displacements_.at(now_); }

  /// Writes to `inPlace`, RGBA8, in the cells of busy blocks: R: 1 in such a part.
  void find(const scene::ArFrame& frame, const gpu::Texture& candidates, const BusyBlocks& blocks,
            const gpu::Texture& inPlace);

 private:
  gpu::Program follow_;
  gpu::Program find_;
  gpu::Texture noIds_;
  std::array<gpu::Texture, 2> displacements_;
  std::size_t now_ = 0;
};

}  // namespace pleinair::marks
