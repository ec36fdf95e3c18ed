// Purpose: carries labels along the motion of movers, in the blocks where there may be one; for these,
//          what motion_layers.comp has found is found again.
// Inputs:  motion_layers_compare.glsl's; mover_shares.glsl's and mover_motion.glsl's, of the previous
//          frame, and motionScale, this step over that.
// Outputs: as motion_layers.comp's. A group of invocations per block of the first list of
//          busy_blocks.glsl.
// Precision: highp.
#include "pipeline/marks/movers/shaders/busy_blocks.glsl"
#include "pipeline/marks/movers/shaders/motion_layers_compare.glsl"
#include "pipeline/marks/movers/shaders/mover_motion.glsl"
#include "pipeline/marks/movers/shaders/mover_shares.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
uniform float motionScale;

const float kTrustedFrames = 4.0;  // of background, after which its colours count more than flow
const float kSeenOther = 0.6;
// s, at most, of parts of a mover that moves: less than what makes any join the background.
const float kCarriedRest = 0.3;

// The label that a mover had at its place in the previous frame. What comes in from outside before a
// camera that stands is a mover.
vec4 labelBefore(vec2 px) {
  if (isInPicture(px)) return textureLod(labels, inLayers(labels, px), 0.0);
  return isStanding ? vec4(1.0, 0.0, 0.0, 2.0 * kMatureSeconds) : vec4(0.0);
}

// Whether a colour is rather that of the mover that was there in the previous frame.
bool isLikeMover(vec3 now, vec2 back, float unlikeBackground) {
  if (unlikeBackground <= kLeastUnlike + kNoiseDeviations * noise) return false;
  if (!isInPicture(back)) return true;
  vec3 there = textureLod(lastPicture, inLayers(lastPicture, back), 0.0).rgb;
  return apart(now, there) < kLikeMover * unlikeBackground;
}

void main() {
  if (isBeyond(kNearCommand)) return;
  uint block = busyWords[nearAt(int(gl_WorkGroupID.x))];
  ivec2 cell = blockOf(block) * kLayerBlock + ivec2(gl_LocalInvocationID.xy);
  if (any(greaterThanEqual(cell, imageSize(candidates)))) return;
  Seen seen = seenAt(cell);
  if (!hasPast || !isInPicture(seen.from) || isAnother(seen)) return;
  Compared c = compared(seen);
  bool wasOther = c.other > 0.5;
  bool isCarried = false;
  if (mayBeMover(c)) {
    // A plain part of a mover goes with its other parts, or rests where it was.
    int here = isInPicture(seen.from) ? numberAt(seen.from) : 0;
    bool rests = true;
    int highest = int(busyWords[kHighestMover + 1 - int(turn)]);
    for (int number = 1; number <= highest; ++number) {
      vec2 own;
      bool goes = findMoverMotion(seen.px, number, own) && length(own) > kMovedPx;
      if (!goes) continue;
      rests = rests && here != 0 && here != number;
      vec2 back = seen.from - motionScale * own;
      int before = isInPicture(back) ? numberAt(back) : number;
      if (before != 0 && before != number) continue;
      vec4 carried = labelBefore(back);
      if (carried.r <= 0.5) continue;
      isCarried = true;
      c.label = vec4(1.0, c.label.g, min(c.label.b, kCarriedRest), max(c.label.a, carried.a));
      if (isLikeMover(seen.now, back, c.unlike)) c.other = max(c.other, kSeenOther);
    }
    bool isLike = rests && c.label.r > 0.5 && isLikeMover(seen.now, seen.from, c.unlike);
    if (isLike) c.other = max(c.other, kSeenOther);
  }
  if (c.isMoving) {
    vec2 back = seen.px - c.moved.xy;
    vec4 carried = labelBefore(back);
    if (carried.r > 0.5 && isLikeMover(seen.now, back, c.unlike)) c.other = max(c.other, kSeenOther);
    bool isOlder =
        carried.r > c.label.r || (carried.r == c.label.r && carried.a > c.label.a);
    if (isOlder && !c.hasLeft) c.label = carried;
    // The ground is hardly known yet. Measured flow reaches beyond a mover, but nothing changes
    // there.
    if (c.frames < kTrustedFrames && c.changed > 0.3) c.other = 1.0;
    c.changed = max(c.changed, 0.5);
  }
  if (c.other > 0.5 && !wasOther) atomicAdd(otherCells[turn], 1u);
  store(cell, seen.now, c, !c.hasLeft && (c.isMoving || isCarried) ? stepSeconds : 0.0);
  if (c.other > 0.0 || c.label.r > 0.0) {
    atomicOr(busyWords[flagsAt(blockOf(block))], kIsBusy);
  }
}
