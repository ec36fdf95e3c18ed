// Purpose: lists the blocks in which movers may carry something: where something moves or was a
//          mover, or where a cell may be a mover's and one is near.
// Inputs:  busy_blocks.glsl's flags; mover_motion.glsl's, of the previous frame.
// Outputs: busy_blocks.glsl's first list, and its command. One group of invocations for all blocks.
// Precision: highp.
#include "pipeline/marks/shaders/block_list.glsl"
#include "pipeline/marks/shaders/layer_cells.glsl"
#include "pipeline/marks/shaders/mover_motion.glsl"
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
  ivec2 blocks = stretch();
  uint own = 0u;
  for (int i = blocks.x; i < blocks.y; ++i) {
    uint flags = busyWords[kBusyWords + i];
    bool isNear = (flags & kIsNear) != 0u;
    bool mayBe = !isNear && (flags & kMayBeMover) != 0u;
    for (int once = mayBe ? 0 : 1; once < 1; ++once) isNear = isMotionNear(blockOf(uint(i)));
    if (!isNear) continue;
    busyWords[kBusyWords + i] = flags | kIsOfFirst;
    ++own;
  }
  uint count = list(blocks, own, kIsOfFirst, nearAt(0));
  if (gl_LocalInvocationID.x != 0u) return;
  busyWords[kNearCommand] = count;
  busyWords[kNearCommand + 1] = 1u;
  busyWords[kNearCommand + 2] = 1u;
}
