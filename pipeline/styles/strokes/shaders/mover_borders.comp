// Purpose: the borders at which strokes are clipped, where movers may be (borders.glsl), of a picture
//          without segments; objects are not looked at.
// Defines: MOVERS_ONLY, always.
// Inputs:  borders.glsl's; busy_blocks.glsl's.
// Outputs: borders (R32UI). A group of invocations per block of the second list of busy_blocks.glsl.
// Precision: integers; highp for places.
#include "pipeline/marks/movers/shaders/busy_blocks.glsl"
#include "pipeline/styles/strokes/shaders/borders.glsl"
layout(local_size_x = 16, local_size_y = 8) in;
layout(r32ui, binding = 0) writeonly uniform highp uimage2D borders;

void main() {
  if (isBeyond(kBusyCommand)) return;
  const int kInvocations = 128;  // of a group
  // Labels end well inside the blocks beside busy ones, which are listed, too; so do their borders.
  float side = float(kLayerBlock) * kLayerCellPixels;
  vec2 first = side * vec2(blockOf(busyWords[busyAt(int(gl_WorkGroupID.x))]));
  ivec2 low = ivec2(floor(first * pixelsOfFull));
  ivec2 high = min(ivec2(ceil((first + side) * pixelsOfFull)), ivec2(size));
  ivec2 extent = high - low;
  for (int i = int(gl_LocalInvocationIndex); i < extent.x * extent.y; i += kInvocations) {
    ivec2 p = low + ivec2(i % extent.x, i / extent.x);
    imageStore(borders, p, uvec4(borderAt(p)));
  }
}
