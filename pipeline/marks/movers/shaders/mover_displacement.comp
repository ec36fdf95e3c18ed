// Purpose: follows how far what is seen in each block has gone (mover_displacement.glsl), and has
//          the blocks looked at that may be of a mover in place.
// Inputs:  motion: MotionField's field, of texels of kFieldPixels; earlier: the previous frame's
//          displacement; candidates (motion_layers_compare.glsl); background_activity.glsl's; ids
//          (ArFrame) if hasObjects, pixelsOfFull; isStanding: the camera has stood since the previous
//          frame; isHeld: it has until lately, so that what is known stays; else all is forgotten;
//          leastDisplacement, mostError: px of the full image, of motion that is less certain;
//          stepSeconds.
// Outputs: displacement; busy_blocks.glsl's flags. One invocation per block.
// Precision: highp.
#include "pipeline/marks/movers/shaders/background_activity.glsl"
#include "pipeline/marks/movers/shaders/busy_blocks.glsl"
#include "pipeline/marks/movers/shaders/mover_displacement.glsl"
#include "pipeline/marks/tensors/shaders/structure.glsl"
#include "pipeline/scene/render/shaders/object_id.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba16f, binding = 0) writeonly uniform highp image2D displacement;
uniform highp sampler2D motion;
uniform highp sampler2D earlier;
uniform highp sampler2D candidates;
uniform highp usampler2D ids;
uniform bool hasObjects;
uniform vec2 pixelsOfFull;
uniform bool isStanding;
uniform bool isHeld;
uniform float leastDisplacement;
uniform float mostError;
uniform float stepSeconds;

const int kFieldPixels = 8;  // marks::MotionField
const float kFast = 12.0;  // times the least displacement: what goes through the picture
const float kRestContrast = 0.04;      // a block with such edges …
const float kRestCorrelation = 0.985;  // … that are so alike to the remembered ones rests
const float kQuietShare = 0.75;  // dynamicShare() of a block that is no leaves

// The mean motion of a block since the previous frame, of what is certain.
vec2 motionIn(ivec2 block) {
  int side = kLayerBlock * int(kLayerCellPixels) / kFieldPixels;
  ivec2 last = textureSize(motion, 0) - 1;
  vec3 sum = vec3(0.0);
  for (int i = 0; i < side * side; ++i) {
    vec4 moved = texelFetch(motion, min(side * block + ivec2(i % side, i / side), last), 0);
    if (moved.w > 0.5 && moved.z < mostError) sum += vec3(moved.xy, 1.0);
  }
  return sum.xy / max(sum.z, 1.0);
}

// The share of a block that is other content; below 0 where the block is seen to rest.
float othersIn(ivec2 block) {
  ivec2 first = block * kLayerBlock;
  ivec2 end = min(first + kLayerBlock, textureSize(candidates, 0));
  float others = 0.0;
  Structure structure = noStructure();
  for (int y = first.y; y < end.y; y += 2) {
    for (int x = first.x + (y >> 1 & 1); x < end.x; x += 2) {
      vec4 there = texelFetch(candidates, ivec2(x, y), 0);
      others += there.r > 0.5 ? 1.0 : 0.0;
      add(structure, there.ba);
    }
  }
  bool rests = correlates(structure, kRestContrast, kRestCorrelation);
  return rests ? -1.0 : others / max(structure.count, 1.0);
}

// Whether the background there is not dynamic.
bool isQuiet(ivec2 block) {
  vec2 first = vec2(block * kLayerBlock) * kLayerCellPixels;
  float activity = 0.0;
  for (int i = 0; i < 16; ++i) activity += activityAt(first + 4.0 * vec2(i & 3, i >> 2) + 2.0);
  return dynamicShare(activity / 16.0) < kQuietShare;
}

// Whether something goes through the picture beside the block: its flow reaches beyond it.
bool isBesidePassing(ivec2 block) {
  float most = 0.0;
  for (int i = 0; i < 9; ++i) {
    ivec2 at = clamp(block + ivec2(i % 3, i / 3) - 1, ivec2(0), grid - 1);
    most = max(most, texelFetch(earlier, at, 0).z);
  }
  return most >= kPassing;
}

// The displacement's z, from what it was. `far`: how far the block has gone, in least displacements.
float sinceMoved(float was, float far, ivec2 block) {
  if (stepSeconds <= 0.0) return was;
  if (far > kFast || (was >= kPassing && far > 1.0)) return kPassing;
  bool isSure = was >= 0.0 && was < kInPlaceSeconds;
  if (far > 1.0 && isQuiet(block) && (isSure || !isBesidePassing(block))) {
    float moving = max(-was, 0.0) + stepSeconds;
    return isSure || moving > kSureSeconds ? 0.0 : -moving;
  }
  return isSure ? was + stepSeconds : kNever;
}

// Whether a model, or a real thing whose model is known, is in the middle of the block: what goes with
// its pose is no mover.
bool isObject(ivec2 block) {
  if (!hasObjects) return false;
  vec2 px = (vec2(block) + 0.5) * float(kLayerBlock) * kLayerCellPixels;
  ivec2 pixel = min(ivec2(px * pixelsOfFull), textureSize(ids, 0) - 1);
  return objectOf(texelFetch(ids, pixel, 0).r) != 0u;
}

void main() {
  ivec2 block = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(block, grid))) return;
  vec4 now = vec4(0.0, 0.0, kNever, 0.0);
  vec4 before = texelFetch(earlier, block, 0);
  if (isHeld && !isStanding) now = before;
  if (isStanding && !isObject(block)) {
    now.xy = exp(-stepSeconds / kDisplacementSeconds) * before.xy + motionIn(block);
    float far = length(now.xy) / leastDisplacement;
    now.z = sinceMoved(before.z, far, block);
    float others = mayBeInPlace(now) || far > 1.0 ? othersIn(block) : 0.0;
    if (others < 0.0 && now.z < kNever) now.z = kNever;
    now.w = max(others, 0.0);
    if (mayBeInPlace(now)) atomicOr(busyWords[flagsAt(block)], kIsBusy);
  }
  imageStore(displacement, block, now);
}
