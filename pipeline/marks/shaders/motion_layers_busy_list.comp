// Purpose: lists the blocks that have, or are beside, one with other content: all others remain
//          background.
// Inputs:  busy_blocks.glsl's flags.
// Outputs: busy_blocks.glsl's second list, and all commands that follow from it; blocks
//          (mover_parts.glsl): no part. One invocation per block.
// Precision: integers.
#include "pipeline/marks/shaders/busy_blocks.glsl"
#include "pipeline/marks/shaders/mover_parts.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) writeonly buffer Blocks { MoverBlock blocks[]; };

void command(int at, ivec2 groups) {
  busyWords[at] = uint(groups.x);
  busyWords[at + 1] = uint(groups.y);
  busyWords[at + 2] = 1u;
}

void main() {
  ivec2 block = ivec2(gl_GlobalInvocationID.xy);
  ivec2 perBlock = (grid + 7) / 8;  // groups of those that take a block each
  if (block == ivec2(0)) {
    for (int i = 1; i < 3; ++i) {
      busyWords[kBusyCommand + i] = 1u;
      busyWords[kCountCommand + i] = 1u;
    }
    if (busyWords[kWasBusy] != 0u) command(kMotionCommand, perBlock);
  }
  if (any(greaterThanEqual(block, grid))) return;
  int number = block.y * grid.x + block.x;
  blocks[number].parent = kNoPart;
  uint flags = 0u;
  ivec2 low = max(block - 1, ivec2(0));
  ivec2 high = min(block + 1, grid - 1);
  for (int y = low.y; y <= high.y; ++y) {
    for (int x = low.x; x <= high.x; ++x) flags |= busyWords[flagsAt(ivec2(x, y))];
  }
  if ((flags & kIsBusy) == 0u) return;
  uint index = atomicAdd(busyWords[kBusyCommand], 1u);
  busyWords[busyAt(int(index))] = uint(number);
  atomicMax(busyWords[kCountCommand], index / 64u + 1u);  // groups of 64
  command(kPartsCommand, ivec2(1));
  command(kGroundCommand, perBlock);
  command(kMotionCommand, perBlock);
}
