// Purpose: lists the blocks that have, or are beside, one with other content: all others remain
//          background.
// Inputs:  busy_blocks.glsl's flags.
// Outputs: busy_blocks.glsl's second list, and all commands that follow from it; blocks
//          (mover_parts.glsl): no part. One group of invocations for all blocks.
// Precision: integers.
#include "pipeline/marks/shaders/block_list.glsl"
#include "pipeline/marks/shaders/mover_parts.glsl"
layout(std430, binding = 0) writeonly buffer Blocks { MoverBlock blocks[]; };

void command(int at, ivec2 groups) {
  busyWords[at] = uint(groups.x);
  busyWords[at + 1] = uint(groups.y);
  busyWords[at + 2] = 1u;
}

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
  ivec2 mine = stretch();
  uint own = 0u;
  for (int i = mine.x; i < mine.y; ++i) {
    blocks[i].parent = kNoPart;
    if ((flagsAround(blockOf(uint(i))) & kIsBusy) == 0u) continue;
    busyWords[kBusyWords + i] |= kIsOfSecond;
    ++own;
  }
  uint count = list(mine, own, kIsOfSecond, busyAt(0));
  if (gl_LocalInvocationID.x != 0u) return;
  ivec2 perBlock = (grid + 7) / 8;  // groups of those that take a block each
  bool isAny = count != 0u;
  command(kBusyCommand, ivec2(int(count), 1));
  command(kCountCommand, ivec2((int(count) + 63) / 64, 1));
  command(kPartsCommand, ivec2(isAny ? 1 : 0, 1));
  command(kGroundCommand, isAny ? perBlock : ivec2(0));
  command(kMotionCommand, isAny || busyWords[kWasBusy] != 0u ? perBlock : ivec2(0));
}
