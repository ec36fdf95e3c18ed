// Purpose: marks the blocks in which movers may carry something: where something moves or was a
//          mover, or where a cell may be a mover's and one is near.
// Inputs:  busy_blocks.glsl's flags; mover_motion.glsl's, of the previous frame. One invocation per block.
// Outputs: flags: kIsOfFirst.
// Precision: highp.
#include "pipeline/marks/movers/shaders/busy_blocks.glsl"
#include "pipeline/marks/movers/shaders/layer_cells.glsl"
#include "pipeline/marks/movers/shaders/mover_motion.glsl"
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
  if (any(greaterThanEqual(block, grid))) return;
  uint flags = busyWords[flagsAt(block)];
  bool isNear = (flags & kIsNear) != 0u;
  bool mayBe = !isNear && (flags & kMayBeMover) != 0u;
  for (int once = mayBe ? 0 : 1; once < 1; ++once) isNear = isMotionNear(block);
  if (isNear) busyWords[flagsAt(block)] = flags | kIsOfFirst;
}
