#pragma once

#include <glm/vec2.hpp>

#include "hal/pixel_format.h"

namespace pleinair::gpu {

/// How many blocks of 4x4 pixels cover an image: the invocations of a pass that does one each
/// (shaders/pixel_block.glsl).
inline glm::ivec2 pixelBlocksOf(hal::FrameSize size) {
  constexpr int kBlockSide = 4;
  return {(size.width + kBlockSide - 1) / kBlockSide, (size.height + kBlockSide - 1) / kBlockSide};
}

}  // namespace pleinair::gpu
