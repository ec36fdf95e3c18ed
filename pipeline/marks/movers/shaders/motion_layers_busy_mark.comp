// Purpose: marks the blocks that are busy (busy_blocks.glsl), or beside one: all others remain
//          background.
// Inputs:  busy_blocks.glsl's flags. One invocation per block.
// Outputs: flags: kIsOfSecond; blocks (mover_parts.glsl): no part.
// Precision: integers.
#include "pipeline/marks/movers/shaders/busy_blocks.glsl"
#include "pipeline/marks/movers/shaders/mover_parts.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) writeonly buffer Blocks { MoverBlock blocks[]; };

// The flags of a block and of those beside it.
uint flagsAround(ivec2 block) {
  uint flags = 0u;
  ivec2 low = max(block - 1, ivec2(0));
  ivec2 high = min(block + 1, grid - 1);
  for (int y = low.y; y <= high.y; ++y) {
    for (int x = low.x; x <= high.x; ++x) flags |= busyWords[flagsAt(ivec2(x, y))];
  }
  return flags;
}

void main() {
  ivec2 block = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(block, grid))) return;
  blocks[block.y * grid.x + block.x].parent = kNoPart;
  // Atomic, for those beside it read the word meanwhile.
  if ((flagsAround(block) & kIsBusy) != 0u) atomicOr(busyWords[flagsAt(block)], kIsOfSecond);
}
