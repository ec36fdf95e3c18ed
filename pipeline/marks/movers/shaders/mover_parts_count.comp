// Purpose: counts the cells of each mover in blocks.
// Inputs:  labels: this frame's; carried (mover_carry.comp).
// Outputs: blocks (mover_parts.glsl): each its own part. One invocation per block of the second list of
//          busy_blocks.glsl.
// Precision: highp.
#include "pipeline/marks/movers/shaders/busy_blocks.glsl"
#include "pipeline/marks/movers/shaders/mover_parts.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) writeonly buffer Blocks { MoverBlock blocks[]; };
uniform highp sampler2D labels;
uniform highp sampler2D carried;

const int kStep = 2;  // cells: every second one is counted

void main() {
  if (gl_GlobalInvocationID.x >= busyWords[kBusyCommand]) return;
  ivec2 block = blockOf(busyWords[busyAt(int(gl_GlobalInvocationID.x))]);
  ivec2 size = textureSize(labels, 0);
  uvec4 counts = uvec4(0u);
  bool isAny = false;
  for (int y = 0; y < kLayerBlock; ++y) {
    for (int x = 0; x < kLayerBlock; ++x) {
      ivec2 cell = block * kLayerBlock + ivec2(x, y);
      if (any(greaterThanEqual(cell, size)) || texelFetch(labels, cell, 0).r < 0.5) continue;
      isAny = true;
      if (((x | y) & (kStep - 1)) != 0) continue;
      int number = int(255.0 * texelFetch(carried, cell, 0).r + 0.5);
      counts += uvec4(equal(ivec4(number), ivec4(0, 1, 2, 3)));
    }
  }
  int index = block.y * grid.x + block.x;
  if (!isAny) return;
  blocks[index].parent = uint(index);
  for (int i = 0; i < 4; ++i) blocks[index].counts[i] = counts[i];
  for (int i = 0; i < 6; ++i) blocks[index].motion[i] = 0;
  blocks[index].low = uint(block.y);
  blocks[index].high = uint(block.y);
  blocks[index].left = uint(block.x);
  blocks[index].right = uint(block.x);
}
