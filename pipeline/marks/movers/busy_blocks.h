#pragma once

#include <cstddef>

#include <glm/vec2.hpp>

#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/programs/program.h"

namespace pleinair::marks {

/// Commands of shaders/busy_blocks.glsl, by their first words: what a program is dispatched for.
enum class BlockCommand : std::size_t {
  kNear = 0,     ///< a group for each block that may be a mover's
  kBusy = 3,     ///< a group for each block of the second list
  kCount = 6,    ///< an invocation for each of these
  kParts = 9,    ///< one group, if there is a busy block
  kGround = 12,  ///< an invocation for each block, if there is a busy one
  kMotion = 15,  ///< the same, or if there was one in the previous frame
};

/// The blocks in which MotionLayers::labels() and shares() may be other than 0, for passes that
/// have nothing to do elsewhere: the second list of shaders/busy_blocks.glsl. Belongs to the
/// layers, and holds until their next update.
struct BusyBlocks {
  const gpu::Buffer* words = nullptr;  ///< of shaders/busy_blocks.glsl
  glm::ivec2 grid{0};                  ///< blocks

  /// Binds them to a program that includes shaders/busy_blocks.glsl, and returns it. Precondition:
  /// it is in use.
  gpu::Program& bind(gpu::Program& program) const;
  /// Binds them and dispatches the program, which returns where isBeyond() says so.
  void dispatch(gpu::Program& program, GLbitfield barriers,
                BlockCommand command = BlockCommand::kBusy) const;
};

}  // namespace pleinair::marks
