// Purpose: lists the blocks in which movers may carry something: where something moves or was a
//          mover, or where a cell may be a mover's and one is near.
// Inputs:  busy_blocks.glsl's flags; mover_motion.glsl's, of the previous frame.
// Outputs: busy_blocks.glsl's first list, and its command. One invocation per block.
// Precision: highp.
#include "pipeline/marks/shaders/busy_blocks.glsl"
#include "pipeline/marks/shaders/layer_cells.glsl"
#include "pipeline/marks/shaders/mover_motion.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
uniform uint turn;  // as in motion_layers_tally.glsl

// Whether findMoverMotion() may find anything in a block.
bool isMotionNear(ivec2 block) {
  const int kReach = 2;  // blocks, as there
  ivec2 size = sizeOfMotion();
  int rows = int(busyWords[kHighestMover + 1 - int(turn)]);
  for (int row = 0; row < rows; ++row) {
    for (int y = -kReach; y <= kReach; ++y) {
      for (int x = -kReach; x <= kReach; ++x) {
        ivec2 at = clamp(block + ivec2(x, y), ivec2(0), size - 1);
        if (texelFetch(moverMotion, at + ivec2(0, row * size.y), 0).z > 0.0) return true;
      }
    }
  }
  return false;
}

void main() {
  ivec2 block = ivec2(gl_GlobalInvocationID.xy);
  if (block == ivec2(0)) {
    busyWords[kNearCommand + 1] = 1u;
    busyWords[kNearCommand + 2] = 1u;
  }
  if (any(greaterThanEqual(block, grid))) return;
  uint flags = busyWords[flagsAt(block)];
  bool isNear = (flags & kIsNear) != 0u;
  bool mayBe = !isNear && (flags & kMayBeMover) != 0u;
  for (int i = mayBe ? 0 : 1; i < 1; ++i) isNear = isMotionNear(block);
  if (!isNear) return;
  uint index = atomicAdd(busyWords[kNearCommand], 1u);
  busyWords[nearAt(int(index))] = uint(block.y * grid.x + block.x);
}
