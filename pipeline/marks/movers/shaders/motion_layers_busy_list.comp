// Purpose: lists the blocks that motion_layers_busy_mark.comp has marked.
// Inputs:  busy_blocks.glsl's flags.
// Outputs: busy_blocks.glsl's second list, and all commands that follow from it. One group of
//          invocations for all blocks.
// Precision: integers.
#include "pipeline/marks/movers/shaders/block_list.glsl"

void command(int at, ivec2 groups) {
  busyWords[at] = uint(groups.x);
  busyWords[at + 1] = uint(groups.y);
  busyWords[at + 2] = 1u;
}

void main() {
  uint count = list(kIsOfSecond, busyAt(0));
  if (gl_LocalInvocationID.x != 0u) return;
  ivec2 perBlock = (grid + 7) / 8;  // groups of those that take a block each
  bool isAny = count != 0u;
  command(kBusyCommand, ivec2(int(count), 1));
  command(kCountCommand, ivec2((int(count) + 63) / 64, 1));
  command(kPartsCommand, ivec2(isAny ? 1 : 0, 1));
  command(kGroundCommand, isAny ? perBlock : ivec2(0));
  command(kMotionCommand, isAny || busyWords[kWasBusy] != 0u ? perBlock : ivec2(0));
}
