// Purpose: lists the blocks that motion_layers_near_mark.comp has marked.
// Inputs:  busy_blocks.glsl's flags.
// Outputs: busy_blocks.glsl's first list, and its command. One group of invocations for all blocks.
// Precision: integers.
#include "pipeline/marks/movers/shaders/block_list.glsl"

void main() {
  uint count = list(kIsOfFirst, nearAt(0));
  if (gl_LocalInvocationID.x != 0u) return;
  busyWords[kNearCommand] = count;
  busyWords[kNearCommand + 1] = 1u;
  busyWords[kNearCommand + 2] = 1u;
}
