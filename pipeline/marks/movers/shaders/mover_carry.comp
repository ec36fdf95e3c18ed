// Purpose: the mover that each cell of movers belonged to: the one whose motion leads back to a cell
//          of its own. Where several do, one covers another: it is the one whose colours were there.
// Inputs:  labels: this frame's; mover_shares.glsl's, mover_motion.glsl's and lastPicture: the
//          previous frame's; picture: this frame's, in cells; motionScale: this step
//          over that of the motion; motion_layers.glsl's.
// Outputs: carried RGBA8: R: the number of the mover, of 255, 0 if it is not known. One invocation
//          per cell; a group of them per block of
//          the second list of busy_blocks.glsl; elsewhere it has been cleared.
// Precision: highp.
#include "pipeline/marks/movers/shaders/busy_blocks.glsl"
#include "pipeline/marks/movers/shaders/motion_layers.glsl"
#include "pipeline/marks/movers/shaders/mover_motion.glsl"
#include "pipeline/marks/movers/shaders/mover_shares.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba8, binding = 0) writeonly uniform highp image2D carried;
uniform highp sampler2D labels;
uniform highp sampler2D picture;
uniform highp sampler2D lastPicture;
uniform float motionScale;
uniform uint turn;  // as in motion_layers_tally.glsl
uniform int reach;  // 1, of the cells around; a uniform, so that compilers keep loops over them

// How unlike what is seen around a cell is to what was around a place.
float unlikeAround(ivec2 cell, vec2 back) {
  ivec2 last = textureSize(picture, 0) - 1;
  float sum = 0.0;
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -1; x <= 1; ++x) {
      vec2 was = back + kLayerCellPixels * vec2(x, y);
      vec3 now = texelFetch(picture, clamp(cell + ivec2(x, y), ivec2(0), last), 0).rgb;
      sum += apart(now, textureLod(lastPicture, inLayers(lastPicture, was), 0.0).rgb);
    }
  }
  return sum;
}

void main() {
  if (isBeyond(kBusyCommand)) return;
  ivec2 block = blockOf(busyWords[busyAt(int(gl_WorkGroupID.x))]);
  ivec2 cell = block * kLayerBlock + ivec2(gl_LocalInvocationID.xy);
  if (any(greaterThanEqual(cell, imageSize(carried)))) return;
  if (texelFetch(labels, cell, 0).r < 0.5) return;
  vec2 px = (vec2(cell) + 0.5) * kLayerCellPixels;
  vec2 from = px - backgroundShift(px);
  int found = 0;
  float least = 1e9;
  int highest = int(busyWords[kHighestMover + 1 - int(turn)]);
  for (int number = 1; number <= highest; ++number) {
    vec2 own;
    if (!findMoverMotion(px, number, own)) continue;
    vec2 back = from - motionScale * own;
    if (!isInPicture(back) || numberAt(back) != number) continue;
    float unlike = unlikeAround(cell, back);
    if (unlike >= least) continue;
    least = unlike;
    found = number;
  }
  imageStore(carried, cell, vec4(float(found) / 255.0, 0.0, 0.0, 0.0));
}
