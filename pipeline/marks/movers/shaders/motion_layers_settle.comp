// Purpose: adds each cell to the background, as if no other content were near; where there is, the
//          passes that follow write over it. It also ends the turn of what is counted and listed.
// Defines: motion_layers.glsl's.
// Inputs:  motion_layers.glsl's, motion_layers_tally.glsl's, busy_blocks.glsl's,
//          background_activity.glsl's; evidence (motion_layers.comp); picture: this frame's, in
//          cells; background: the previous frame's, if hasPast; freshSeconds,
//          noise: as motion_layers_join.comp's; hasActivity: it was known before, though pictures
//          have another size now.
// Outputs: labels, backgroundNow, activityNow: as motion_layers_join.comp's. One invocation per cell.
// Precision: highp.
#include "pipeline/marks/movers/shaders/background_mean.glsl"
#include "pipeline/marks/movers/shaders/busy_blocks.glsl"
#include "pipeline/marks/movers/shaders/motion_layers.glsl"
#include "pipeline/marks/movers/shaders/motion_layers_tally.glsl"
#include "pipeline/marks/movers/shaders/background_activity.glsl"
layout(local_size_x = 16, local_size_y = 4) in;
layout(rgba16f, binding = 0) writeonly uniform highp image2D labels;
layout(rgba16f, binding = 1) writeonly uniform highp image2D backgroundNow;
layout(r32f, binding = 2) writeonly uniform highp image2D activityNow;
uniform highp sampler2D evidence;
uniform highp sampler2D picture;
uniform highp sampler2D background;
uniform bool hasPast;
uniform bool hasActivity;
uniform float noise;
uniform float freshSeconds;

void main() {
  ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (cell == ivec2(0)) {
    otherCells[1u - turn] = 0u;
    changedBlocks[1u - turn] = 0u;
    keptBlocks[1u - turn] = 0u;
    busyWords[kWasBusy] = busyWords[kBusyCommand];
    busyWords[kHighestMover + int(turn)] = 0u;
  }
  if (any(greaterThanEqual(cell, imageSize(labels)))) return;
  if (all(equal(cell % kLayerBlock, ivec2(0)))) busyWords[flagsAt(cell / kLayerBlock)] = 0u;
  vec3 now = texelFetch(picture, cell, 0).rgb;
  if (!hasPast) {
    imageStore(labels, cell, vec4(0.0));
    imageStore(backgroundNow, cell, vec4(now, 1.0));
    vec2 here = (vec2(cell) + 0.5) * kLayerCellPixels;
    imageStore(activityNow, cell, vec4(hasActivity ? activityAt(here) : 0.0));
    return;
  }
  vec4 past = texelFetch(evidence, cell, 0);
  vec2 px = (vec2(cell) + 0.5) * kLayerCellPixels;
  vec2 from = px - backgroundShift(px);
  vec4 known = vec4(now, 0.0);
  if (isInPicture(from) && past.r >= 0.0) known = pastAt(background, from);
  float activity = known.a < 0.5 ? 0.0 : activityAt(from);
  float unlike = isStanding ? max(apart(now, known.rgb) - kNoiseMean * noise, 0.0) : 0.0;
  if (known.a >= 0.5) {
    activity = activityAfter(activity, min(unlike, kMostUnlike), stepSeconds, kActivitySeconds);
  }
  imageStore(activityNow, cell, vec4(activity));
  float frames = framesWith(known.a, isStanding ? kFrames : kMovingFrames);
  imageStore(backgroundNow, cell, withColour(known, now, frames));
  float fresh = max(past.a - stepSeconds / freshSeconds, 0.0);
  imageStore(labels, cell, vec4(0.0, fresh, min(past.g + stepSeconds, 0.0), 0.0));
}
