#pragma once

#include <cstddef>

#include <glm/vec2.hpp>

#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/program.h"

namespace pleinair::marks {

/// The blocks in which MotionLayers::labels() and shares() may be other than 0, for passes that
/// have nothing to do elsewhere: the second list of shaders/busy_blocks.glsl. Belongs to the
/// layers, and holds until their next update.
struct BusyBlocks {
  const gpu::Buffer* words = nullptr;  ///< of shaders/busy_blocks.glsl
  std::size_t commandBytes = 0;  ///< offset of the command that dispatches a group for each block
  glm::ivec2 grid{0};            ///< blocks

  /// Dispatches a group for each block. Precondition: the program, which includes
  /// shaders/busy_blocks.glsl, is in use.
  void dispatch(gpu::Program& program, GLbitfield barriers) const {
    program.storage("BusyBlocks", *words)
        .set("grid", grid)
        .dispatchIndirect(*words, commandBytes, barriers);
  }
};

}  // namespace pleinair::marks
