// Purpose: a cell's two washes: the light one, which is painted first, and the dark one, which is
//          glazed over it. The two colours and their shares preserve the moments of the cell's
//          pixels (moment-preserving thresholding: Tsai, 1985; Delp and Mitchell, 1979). The
//          moments are averaged over time, so that a cell that gains or loses pixels changes its
//          colours slowly.
// Inputs:  moments (moments.glsl; cleared here for the next frame), seeds (seed.glsl), past: this
//          pass's mean moments of the previous frame; slots; kept: the part of the past's weight
//          that remains, 0 without a past. A new cell takes the past of the cell in which it was
//          spawned.
// Outputs: darkWash, lightWash (RGBA8): sRGB-coded; A of the light one: its share. now: per cell 8
//          floats: mean R, G, B in levels, frames' worth of pixels; L R, L G, L B, L³ / 16.
// Precision: highp; a frame's sums below 2^24 are exact.
#include "pipeline/styles/watercolor/shaders/moments.glsl"
#include "pipeline/styles/watercolor/shaders/seed.glsl"
#include "pipeline/styles/watercolor/shaders/tiling_word.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer Moments { uint moments[]; };
layout(std430, binding = 1) readonly buffer Seeds { Seed seeds[]; };
layout(std430, binding = 2) readonly buffer Past { vec4 past[]; };
layout(std430, binding = 3) volatile writeonly buffer Now { vec4 now[]; };  // docs/gpu.md, rule 22
layout(binding = 0, rgba8) writeonly uniform highp image2D darkWash;
layout(binding = 1, rgba8) writeonly uniform highp image2D lightWash;
uniform int slots;
uniform float kept;

const vec3 kLuma = vec3(kMomentLuma) / 8.0;  // in levels
const float kMinSpread = 3.0;  // levels; below it, a cell has one colour
const float kWholeCell = 6.0;     // pixels of the guide that count as a frame's worth
const float kMaxFrames = 64.0;

// The mean of a frame's moments and the past's; first.w is the weight.
void average(inout vec4 first, inout vec4 second, int slot) {
  uint parent = seeds[slot].parent;
  bool isBorn = (seeds[slot].state & kBornSeed) != 0u;
  int from = isBorn ? int(parent) - 1 : slot;
  if (kept <= 0.0 || from < 0) return;
  vec4 firstThen = past[2 * from];
  vec4 secondThen = past[2 * from + 1];
  // A lasting change is adopted at once.
  float apart = length(first.rgb - firstThen.rgb);
  float alike = first.w > 0.0 ? 1.0 - smoothstep(12.0, 40.0, apart) : 1.0;
  float before = kept * alike * min(firstThen.w, kMaxFrames);
  float all = before + first.w;
  if (all <= 0.0) return;
  first.rgb = (before * firstThen.rgb + first.w * first.rgb) / all;
  second = (before * secondThen + first.w * second) / all;
  first.w = all;
}

void main() {
  int slot = int(gl_GlobalInvocationID.x);
  if (slot >= slots) return;
  int base = slot * kMomentWords;
  uint pixels = moments[base + 3];
  vec4 first = vec4(0.0);
  vec4 second = vec4(0.0);
  if (pixels > 0u) {
    float count = float(pixels);
    first = vec4(vec3(uvec3(moments[base], moments[base + 1], moments[base + 2])) / count,
                 min(count / kWholeCell, 1.0));
    second = vec4(vec3(uvec3(moments[base + 4], moments[base + 5], moments[base + 6])) / (8.0 * count),
                  float(moments[base + 7]) * 16.0 / count);
  }
  // Word by word: docs/gpu.md, rules 19 and 22.
  int words = pixels > 0u ? kMomentWords : 0;
  for (int i = 0; i < words; ++i) moments[base + i] = 0u;
  if ((seeds[slot].state & kLiving) != 0u) average(first, second, slot);
  now[2 * slot].xy = first.xy;
  now[2 * slot].zw = first.zw;
  now[2 * slot + 1].xy = second.xy;
  now[2 * slot + 1].zw = second.zw;

  vec3 mean = first.rgb;
  float m = dot(mean, kLuma);
  float variance = dot(second.rgb, kLuma) - m * m;
  vec3 dark = mean / 255.0;
  vec3 light = dark;
  float share = 0.5;
  if (variance > kMinSpread * kMinSpread) {
    float spread = sqrt(variance);
    float third = second.a - 3.0 * m * variance - m * m * m;
    float skew = clamp(third / (variance * spread), -4.0, 4.0);
    float up = 0.5 * (skew + sqrt(skew * skew + 4.0));  // the light colour, in standard deviations
    vec3 slope = (second.rgb - m * mean) / variance;  // of colour over luma
    light = clamp((mean + slope * spread * up) / 255.0, 0.0, 1.0);
    dark = clamp((mean - slope * spread / up) / 255.0, 0.0, 1.0);
    share = 1.0 / (1.0 + up * up);
  }
  imageStore(darkWash, texelOf(uint(slot)), vec4(dark, 1.0));
  imageStore(lightWash, texelOf(uint(slot)), vec4(light, share));
}
