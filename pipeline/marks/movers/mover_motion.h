#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/pixel_format.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/marks/motion_field.h"
#include "pipeline/marks/movers/background_binding.h"
#include "pipeline/marks/movers/busy_blocks.h"
#include "pipeline/scene/render/ar_frame.h"

namespace pleinair::marks {

/// A frame whose movers have been told apart, and the one before it; textures of MotionLayers.
struct MoverFrames {
  const scene::ArFrame* frame = nullptr;
  const MotionField* field = nullptr;
  std::uint64_t last = 0;  ///< sequence number of the previous frame
  bool hasPast = false;
  const gpu::Texture* shares = nullptr;
  const gpu::Texture* lastShares = nullptr;
  const gpu::Texture* picture = nullptr;
  const gpu::Texture* lastPicture = nullptr;
  BusyBlocks blocks;
  unsigned turn = 0;  ///< as in shaders/motion_layers_tally.glsl
  float stepSeconds = 0.0F;
  float motionScale = 1.0F;  ///< `stepSeconds` divided by the previous frame's
};

/// How movers move, in blocks: from dense flow at their edges, then from how they lie on the
/// previous frame's (Lucas & Kanade, "An iterative image registration technique", 1981), smoothed.
/// All calls on the thread of the GL context that was current at construction.
class MoverMotion {
 public:
  /// `blocks` is the number of blocks of MotionLayers. Throws hal::Failure if GPU memory runs out.
  MoverMotion(const gpu::ShaderLibrary& library, hal::FrameSize blocks);

  /// `binding` is that of the layers.
  void update(const MoverFrames& frames, const BackgroundBinding& binding);

  /// MotionLayers::moverMotion(): of the last update.
  const gpu::Texture& motion() const { return motions_.at(at_); }

 private:
  struct Weights;
  void solve(const MoverFrames& frames, std::size_t which, const Weights& weights);

  gpu::Program findEdges_;
  gpu::Program findMotion_;
  gpu::Program smoothMotion_;
  gpu::Program registerMovers_;
  std::array<gpu::Texture, 2> normals_;
  std::array<gpu::Texture, 2> normalFlow_;
  std::array<gpu::Texture, 2> motions_;  // at_ is the last that was found
  std::size_t at_ = 0;
};

}  // namespace pleinair::marks
