// Purpose: the mean colour of what is surely background, in blocks of cells: what a place that is
//          other content may be expected to look like if it has just been uncovered.
// Inputs:  candidates, evidence (motion_layers.comp); picture: this frame's, in cells.
// Outputs: ground RGBA16F: the colour times the share of the block that is background, and that
//          share. One invocation per block of kLayerBlock² cells.
// Precision: highp.
#include "pipeline/marks/shaders/layer_blocks.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba16f, binding = 0) writeonly uniform highp image2D ground;
uniform highp sampler2D candidates;
uniform highp sampler2D evidence;
uniform highp sampler2D picture;

void main() {
  ivec2 block = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(block, imageSize(ground)))) return;
  ivec2 first = block * kLayerBlock;
  ivec2 end = min(first + kLayerBlock, textureSize(candidates, 0));
  vec4 sum = vec4(0.0);
  for (int y = first.y; y < end.y; y += 2) {
    for (int x = first.x; x < end.x; x += 2) {
      vec2 seen = texelFetch(candidates, ivec2(x, y), 0).rg;
      bool isGround = seen.r < 0.15 && seen.g < 0.1 && texelFetch(evidence, ivec2(x, y), 0).r >= 0.0;
      if (isGround) sum += vec4(texelFetch(picture, ivec2(x, y), 0).rgb, 1.0);
    }
  }
  imageStore(ground, block, sum * (4.0 / float(kLayerBlock * kLayerBlock)));
}
