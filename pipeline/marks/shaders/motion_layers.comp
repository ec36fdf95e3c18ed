// Purpose: compares each cell of the picture with the remembered background and with the previous
//          frame, and carries its label along the motion (marks/motion_layers.h).
// Inputs:  motion_layers.glsl's, motion_layers_tally.glsl's; picture (ArFrame::camera());
//          lastPicture, background, labels, mover_shares.glsl's: the previous frame's, if hasPast; motion: MotionField's
//          field; mover_motion.glsl's, of the previous frame, and motionScale, this step over that;
//          noise: sigma of a cell, in [0, 1].
// Outputs: candidates RGBA8: how surely it is other content than the background, the carried label,
//          luma now and of the background. evidence RGBA16F: whether it has changed since the
//          previous frame, or -2 where another real thing's model was before;
//          carried rest, carried maturity (below 0: a mover has left), carried freshness.
//          pictureNow RGBA8: the picture in cells, and in A the real thing that it shows.
//          otherCells: how many cells are surely other content. One invocation per cell.
// Precision: highp.
#include "pipeline/gpu/shaders/luma.glsl"
#include "pipeline/marks/shaders/layer_blocks.glsl"
#include "pipeline/marks/shaders/motion_layers.glsl"
#include "pipeline/marks/shaders/motion_layers_tally.glsl"
#include "pipeline/marks/shaders/mover_motion.glsl"
#include "pipeline/marks/shaders/mover_shares.glsl"
layout(local_size_x = 16, local_size_y = 4) in;
layout(rgba8, binding = 0) writeonly uniform highp image2D candidates;
layout(rgba16f, binding = 1) writeonly uniform highp image2D evidence;
layout(rgba8, binding = 2) writeonly uniform highp image2D pictureNow;
uniform highp sampler2D picture;
uniform highp sampler2D lastPicture;
uniform highp sampler2D background;
uniform highp sampler2D labels;
uniform highp sampler2D motion;
uniform bool hasPast;
uniform float noise;
uniform float motionScale;

const float kSlack = 0.035;
const float kNoiseDeviations = 3.0;
const float kMovingSlack = 1.6;  // of a camera that moves: the past is interpolated
const float kCertainThresholds = 2.4;  // at so many thresholds, other content is certain
const float kTrustedFrames = 4.0;  // of background, after which its colours count more than flow
const float kReach = 2.5;  // px
const float kMovedPx = 0.6;  // less may be an error of the flow, at any rate of frames
const float kLeastUnlike = 0.008;  // of colour
const float kSeenOther = 0.6;
// s, at most, of parts of a mover that moves: less than what makes any join the background.
const float kCarriedRest = 0.3;

// How surely the colour is the background's in a shadow, or in a little more light.
float shadeOf(vec3 now, vec3 known) {
  float before = lumaOf(known);
  float ratio = lumaOf(now) / max(before, 1e-3);
  if (before < 0.12 || ratio < 0.68 || ratio > 1.12) return 0.0;
  return 1.0 - smoothstep(0.5, 1.0, apart(now / ratio, known) / (kSlack + kNoiseDeviations * noise));
}

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

// A number for the real thing of an object, 0 for none. Few share one.
float thingOf(uint object) { return object < kRealObject ? 0.0 : 1.0 + float(object % 255u); }

void main() {
  ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  ivec2 cells = imageSize(candidates);
  if (any(greaterThanEqual(cell, cells))) return;
  vec2 px = (vec2(cell) + 0.5) * kLayerCellPixels;
  vec3 now = textureLod(picture, px / fullSize, 0.0).rgb;
  uint object = objectAt(px);
  float thing = thingOf(object);
  imageStore(pictureNow, cell, vec4(now, thing / 255.0));
  vec2 shift = backgroundShift(px);
  vec2 from = px - shift;
  float luma = lumaOf(now);
  bool isAnother = false;
  if (hasPast && isInPicture(from)) {
    ivec2 there = min(ivec2(from / kLayerCellPixels), textureSize(lastPicture, 0) - 1);
    isAnother = abs(255.0 * texelFetch(lastPicture, there, 0).a - thing) > 0.5;
  }
  if (!hasPast || isAnother || !isInPicture(from)) {
    imageStore(candidates, cell, vec4(0.0, 0.0, luma, luma));
    imageStore(evidence, cell, vec4(isAnother ? -2.0 : 0.0, 0.0, 0.0, 0.0));
    return;
  }
  // While the camera moves, colours are compared with all those around.
  vec3 low = now;
  vec3 high = now;
  if (!isStanding) {
    for (int i = 0; i < 4; ++i) {
      vec2 at = px + kReach * (2.0 * vec2(i & 1, i >> 1) - 1.0);
      vec3 there = textureLod(picture, at / fullSize, 0.0).rgb;
      low = min(low, there);
      high = max(high, there);
    }
  }
  vec4 known = textureLod(background, inLayers(background, from), 0.0);
  vec3 before = textureLod(lastPicture, inLayers(lastPicture, from), 0.0).rgb;
  float least = (isStanding ? 1.0 : kMovingSlack) * (kSlack + kNoiseDeviations * noise);
  float unlike = known.a < 0.5 ? 0.0 : beyond(known.rgb, low, high);
  float other = smoothstep(least, kCertainThresholds * least, unlike);
  other *= 1.0 - shadeOf(now, known.rgb);
  float changed = smoothstep(least, kCertainThresholds * least, beyond(before, low, high));

  vec4 moved = textureLod(motion, px / fullSize, 0.0);
  // Measured motion may still be that of most of the image.
  float otherwise = min(distance(moved.xy, shift), distance(moved.xy, pictureShift(px)));
  bool isMoving = moved.w > 0.5 && moved.z < 3.0 && otherwise > kMovedPx + 2.5 * moved.z;
  vec4 label = textureLod(labels, inLayers(labels, from), 0.0);
  bool isCarried = false;
  if (!isMoving && changed > 0.5) label.a = 0.0;  // something else is seen there
  // A mover has uncovered the place: the motion beside it is that mover's.
  bool hasLeft = label.a < 0.0 && changed <= 0.5;
  bool mayBeMover = !isMoving && !hasLeft &&
                    (max(label.r, other) > 0.5 || unlike > kLeastUnlike + kNoiseDeviations * noise);
  if (mayBeMover) {
    // A plain part of a mover goes with its other parts, or rests where it was.
    int here = isInPicture(from) ? numberAt(from) : 0;
    bool rests = true;
    for (int number = 1; number <= kMostMovers; ++number) {
      vec2 own;
      bool goes = findMoverMotion(px, number, own) && length(own) > kMovedPx;
      if (!goes) continue;
      rests = rests && here != 0 && here != number;
      vec2 back = from - motionScale * own;
      int before = isInPicture(back) ? numberAt(back) : number;
      if (before != 0 && before != number) continue;
      vec4 carried = labelBefore(back);
      if (carried.r <= 0.5) continue;
      isCarried = true;
      label = vec4(1.0, label.g, min(label.b, kCarriedRest), max(label.a, carried.a));
      if (isLikeMover(now, back, unlike)) other = max(other, kSeenOther);
    }
    if (rests && label.r > 0.5 && isLikeMover(now, from, unlike)) other = max(other, kSeenOther);
  }
  if (isMoving) {
    vec2 back = px - moved.xy;
    vec4 carried = labelBefore(back);
    if (carried.r > 0.5 && isLikeMover(now, back, unlike)) other = max(other, kSeenOther);
    bool isOlder = carried.r > label.r || (carried.r == label.r && carried.a > label.a);
    if (isOlder && !hasLeft) label = carried;
    // The ground is hardly known yet. Measured flow reaches beyond a mover, but nothing changes
    // there.
    if (known.a < kTrustedFrames && changed > 0.3) other = 1.0;
    changed = max(changed, 0.5);
  }
  if (other > 0.5) atomicAdd(otherCells[turn], 1u);
  imageStore(candidates, cell, vec4(other, label.r, luma, lumaOf(known.rgb)));
  float maturity = label.a + (!hasLeft && (isMoving || isCarried) ? stepSeconds : 0.0);
  imageStore(evidence, cell, vec4(changed, label.b, maturity, label.g));
}
