// Purpose: the mean colour of what is surely background, in blocks of cells: what a place that is
//          other content may be expected to look like if it has just been uncovered. It also
//          counts the blocks with edges that have changed, and those of them that have kept their
//          edges: most do if the light changes. Leaves in the wind do, too: they do not count.
// Inputs:  candidates, evidence (motion_layers.comp); picture: this frame's, in cells;
//          busy_blocks.glsl's commands; background_activity.glsl's.
// Outputs: ground RGBA16F: the colour times the share of the block that is background, and that
//          share. changedBlocks, keptBlocks (motion_layers_tally.glsl). One invocation per block of
//          kLayerBlock² cells.
// Precision: highp.
#include "pipeline/marks/movers/shaders/busy_blocks.glsl"
#include "pipeline/marks/movers/shaders/motion_layers_tally.glsl"
#include "pipeline/marks/tensors/shaders/structure.glsl"
#include "pipeline/marks/movers/shaders/background_activity.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba16f, binding = 0) writeonly uniform highp image2D ground;
uniform highp sampler2D candidates;
uniform highp sampler2D evidence;
uniform highp sampler2D picture;

const float kChanged = 0.3;  // of a block: then it counts

void main() {
  if (isBeyond(kGroundCommand)) return;
  ivec2 block = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(block, imageSize(ground)))) return;
  ivec2 first = block * kLayerBlock;
  ivec2 end = min(first + kLayerBlock, textureSize(candidates, 0));
  vec4 sum = vec4(0.0);
  Structure structure = noStructure();
  float changed = 0.0;
  float activity = 0.0;
  for (int y = first.y; y < end.y; y += 2) {
    for (int x = first.x; x < end.x; x += 2) {
      vec4 seen = texelFetch(candidates, ivec2(x, y), 0);
      float change = texelFetch(evidence, ivec2(x, y), 0).r;
      add(structure, seen.ba);
      changed += max(change, 0.0);
      activity += activityAt((vec2(x, y) + 0.5) * kLayerCellPixels);
      bool isGround = seen.r < 0.15 && seen.g < 0.1 && change >= 0.0;
      if (isGround) sum += vec4(texelFetch(picture, ivec2(x, y), 0).rgb, 1.0);
    }
  }
  bool isQuiet = dynamicShare(activity / max(structure.count, 1.0)) < 1.0;
  if (isQuiet && hasEdges(structure) && changed > kChanged * structure.count) {
    atomicAdd(changedBlocks[turn], 1u);
    if (isSame(structure)) atomicAdd(keptBlocks[turn], 1u);
  }
  imageStore(ground, block, sum * (4.0 / float(kLayerBlock * kLayerBlock)));
}
