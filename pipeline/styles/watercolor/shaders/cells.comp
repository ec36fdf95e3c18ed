// Purpose: each seed's next place: the mean of its cell's edge pixels if there are enough (thesis
//          §3.2.3), else the centroid of its cell, which spaces seeds evenly (Lloyd, "Least squares
//          quantization in PCM", 1982). A seed rests exactly until that place has been far away for
//          a while, so that noise moves no seed; while it is held (seeds.comp), it rests. Also each
//          cell's exact mean colour (§3.2.1).
// Inputs:  sums (cell_sums.glsl; cleared here for the next frame), points (seeds.comp), slots,
//          pixelsOfFull, minEdgePixels; follow and drift: the parts in [0, 1] of the way to the
//          edge and to the centroid; reach: as in seeds.comp; rest: px of the full image within
//          which a place is not far; patience and passed: s; atOnce: without rest.
// Outputs: seeds; meansNow (RGBA16F, if wantsMeans): linear mean; 1 where the cell has pixels.
// Precision: sums are exact.
#include "pipeline/marks/anchors/shaders/point.glsl"
#include "pipeline/styles/watercolor/shaders/cell_sums.glsl"
#include "pipeline/styles/watercolor/shaders/seed.glsl"
#include "pipeline/styles/watercolor/shaders/tiling_word.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) volatile buffer Seeds { Seed seeds[]; };  // docs/gpu.md, rule 22
layout(std430, binding = 1) buffer Sums { uint sums[]; };
layout(std430, binding = 2) readonly buffer Points { ivec4 points[]; };
layout(binding = 0, rgba16f) writeonly uniform highp image2D means;
uniform int slots;
uniform vec2 pixelsOfFull;
uniform uint minEdgePixels;
uniform float follow;
uniform float drift;
uniform float reach;
uniform float rest;
uniform float patience;
uniform float passed;
uniform bool atOnce;
uniform bool wantsMeans;

const float kArrived = 0.25;  // of `rest`

// Divides whole pixels first: a sum can have more bits than a float.
vec2 meanOf(uvec2 sum, uint count) {
  uvec2 whole = sum / count;
  return vec2(whole) + vec2(sum - whole * count) / float(count) + 0.5;
}

// The weight of the edge pixels against the cell's centroid: 1 in the thesis's manner (without a
// drift to the centroid), else growing with their number, so that single pixels that come and go
// change little.
float pullOf(uint edges) {
  float number = float(edges);
  float least = float(minEdgePixels);
  return drift > 0.0 ? clamp((number - 0.5 * least) / (1.5 * least), 0.0, 1.0) : step(least, number);
}

// The seed's step in this frame, px of the full image.
vec2 stepOf(inout Seed seed, vec2 way, float part) {
  if (atOnce) {
    seed.state &= ~kMoving;
    seed.restless = 0.0;
    return way * part;
  }
  float far = length(way);
  bool isMoving = (seed.state & kMoving) != 0u;
  // A seed whose distance hovers about the limit because of noise does not move.
  float reason = clamp(4.0 * (far / max(rest, 1.0e-4) - 1.0), -2.0, 1.0);
  seed.restless = isMoving ? 0.0 : max(0.0, seed.restless + passed * reason);
  if (!isMoving && seed.restless > patience) isMoving = true;
  if (far <= kArrived * rest || part <= 0.0) isMoving = false;
  if (rest <= 0.0) isMoving = far > 0.0;
  seed.state = (seed.state & ~kMoving) | (isMoving ? kMoving : 0u);
  return isMoving ? way * part : vec2(0.0);
}

void main() {
  int slot = int(gl_GlobalInvocationID.x);
  if (slot >= slots) return;
  int base = slot * kSumWords;
  uint count = sums[base + 3];
  if (wantsMeans) {
    vec3 sum = vec3(uvec3(sums[base], sums[base + 1], sums[base + 2]));
    vec4 mean = count > 0u ? vec4(sum / (float(count) * kLinearUnits), 1.0) : vec4(0.0);
    imageStore(means, texelOf(uint(slot)), mean);
  }
  ivec4 point = points[slot];
  bool isHeld = (seeds[slot].state & kHeldSeed) != 0u;
  if (isHeld) seeds[slot].restless = 0.0;
  if (point.w >= 0 && count > 0u && !isHeld) {
    Seed seed = seeds[slot];
    uint edges = sums[base + 6];
    float pull = pullOf(edges);
    vec2 target = mix(meanOf(uvec2(sums[base + 7], sums[base + 8]), count),
                      meanOf(uvec2(sums[base + 4], sums[base + 5]), max(edges, 1u)), pull);
    vec2 way = (target - pointPlace(point)) / pixelsOfFull;
    float away = length(seed.offset + way);
    if (away > reach) way = (seed.offset + way) * (reach / away) - seed.offset;
    seed.offset += stepOf(seed, way, mix(drift, follow, pull));
    seeds[slot].offset = seed.offset;
    seeds[slot].restless = seed.restless;
    seeds[slot].state = seed.state;
  }
  // Word by word: docs/gpu.md, rules 19 and 22.
  int words = count > 0u ? kSumWords : 0;
  for (int i = 0; i < words; ++i) sums[base + i] = 0u;
}
