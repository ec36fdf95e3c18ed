// Purpose: spaces parallel lines evenly: shifts each across its direction to where those around it
//          would have a line if all were a whole number of spacings apart. A line's phase is kept
//          in step with its neighbours', as that of the kernels of phasor noise (Tricard et al.,
//          "Procedural phasor noise", 2019).
// Inputs:  anchors; lines: labels; starts, sorted, bins, binPixels: all of them (line_points.comp); before: the
//          shifts of the previous step; field.glsl's; spacing, reach: px; anew, isFirst: lines have
//          no past; line_past.glsl's.
// Outputs: shifts (RGBA32F, a texel a slot: line_shift.glsl): px. One invocation per anchor.
// Precision: highp.
#include "pipeline/gpu/shaders/hash.glsl"
#include "pipeline/marks/anchors/shaders/anchor.glsl"
#include "pipeline/marks/anchors/shaders/point_bins.glsl"
#include "pipeline/styles/hatching/shaders/line.glsl"
#include "pipeline/styles/hatching/shaders/line_past.glsl"
#include "pipeline/styles/hatching/shaders/line_shift.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Anchors { Anchor anchors[]; };
layout(std430, binding = 1) readonly buffer Starts { uint starts[]; };
layout(std430, binding = 2) readonly buffer Sorted { ivec4 sorted[]; };
layout(std430, binding = 3) readonly buffer Lines { Line lines[]; };
layout(rgba32f, binding = 0) writeonly uniform highp image2D shifts;
#include "pipeline/styles/hatching/shaders/field.glsl"
uniform highp sampler2D before;
uniform uint slots;
uniform bool anew;     // the first of the first steps
uniform bool isFirst;  // one of them
uniform float spacing;
uniform float reach;

const float kTurn = 6.2831853;

vec2 acrossAt(vec2 px, uint support) {
  vec2 way = directionAt(px, support);
  return vec2(-way.y, way.x);
}

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= slots) return;
  uint state = anchors[slot].state;
  if (!isAlive(state)) return;
  vec2 px = anchors[slot].px;
  uint support = lines[slot].label;
  bool isNew = anew || (!isFirst && (state & kBorn) != 0u);
  vec2 was = texelFetch(before, shiftTexel(int(slot)), 0).xy;
  vec4 jacobian = anchors[slot].jacobian;
  if (isFirst) jacobian = vec4(1.0, 0.0, 0.0, 1.0);
  was = isNew ? vec2(0.0) : jacobian.xy * was.x + jacobian.zw * was.y;
  vec2 across = acrossAt(px, support);
  float own = dot(was, across);
  // The part along the field is kept: when the field turns back, it is across it again.
  vec2 alongField = isNew || isFirst ? vec2(0.0) : pastOn(support) * (was - own * across);
  if (anew) own = spacing * (unitOf(hashOf(anchors[slot].seed ^ 0x43u)) - 0.5);
  ivec2 low = binOf(px - reach);
  ivec2 high = binOf(px + reach);
  vec2 sum = vec2(0.0);
  float weights = 0.0;
  for (int row = low.y; row <= high.y && !anew; ++row) {
    uint end = starts[row * bins.x + high.x + 1];
    for (uint i = starts[row * bins.x + low.x]; i < end; ++i) {
      ivec4 point = sorted[i];
      // A new line has no place yet, unless all are new.
      uint other = isFirst ? uint(point.z) & ~kJustBorn : uint(point.z);
      if (point.w == int(slot) || other != support) continue;
      vec2 there = pointPlace(point);
      vec2 apart = there - px;
      float near = dot(apart, apart) / (reach * reach);
      if (near >= 1.0) continue;
      vec2 acrossThere = acrossAt(there, support);
      float along = dot(across, acrossThere);
      if (along < 0.0) acrossThere = -acrossThere;
      float weight = (1.0 - near) * (1.0 - near) * along * along * along * along;
      vec2 shift = texelFetch(before, shiftTexel(point.w), 0).xy;
      vec2 line = there + acrossThere * dot(acrossThere, shift);
      vec2 mean = across + acrossThere;
      float phase = kTurn * dot(mean, line - px) * inversesqrt(dot(mean, mean)) / spacing;
      sum += weight * vec2(cos(phase), sin(phase));
      weights += weight;
    }
  }
  float agreement = length(sum) / max(weights, 1e-4);
  if (agreement > 0.02) {
    float target = spacing / kTurn * atan(sum.y, sum.x);
    target += spacing * round((own - target) / spacing);
    own = isNew ? target : mix(target, own, pastOn(support));
  }
  own = clamp(own, -spacing, spacing);
  imageStore(shifts, shiftTexel(int(slot)), vec4(own * across + alongField, agreement, 0.0));
}
