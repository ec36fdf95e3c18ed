// Purpose: traces each anchor's line along the field, both ways, and blends it with its past, so
//          that a line lives as long as its anchor. It ends at borders of patches and movers, and
//          where the field turns too sharply; where the tone asks for no line, its width is 0.
// Inputs:  anchors; field.glsl's and tone.glsl's; line_support.glsl's; shifts:
//          those of line_align.comp; jitter: px by which lines are off at random, ±; anew: lines
//          have no past; cellPixels: of the anchors; segment: px; steps: an arm's length in segments, at most
//          kArm; cutOff: cosine; wander: rad; past: line_past.glsl's.
// Outputs: lines. One invocation per anchor.
// Precision: highp.
#include "pipeline/gpu/shaders/hash.glsl"
#include "pipeline/marks/shaders/anchor.glsl"
#include "pipeline/marks/shaders/stroke_history.glsl"
#include "pipeline/styles/hatching/shaders/line.glsl"
#include "pipeline/styles/hatching/shaders/line_past.glsl"
#include "pipeline/styles/hatching/shaders/line_shift.glsl"
#include "pipeline/styles/hatching/shaders/line_support.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Anchors { Anchor anchors[]; };
layout(std430, binding = 1) buffer Lines { Line lines[]; };
#include "pipeline/styles/hatching/shaders/field.glsl"
#include "pipeline/styles/hatching/shaders/tone.glsl"
uniform uint slots;
uniform bool anew;
uniform float cellPixels;
uniform float segment;
uniform float steps;
uniform float cutOff;
uniform float wander;
uniform highp sampler2D shifts;
uniform float jitter;

vec2 turned(vec2 way, float angle) {
  float c = cos(angle);
  float s = sin(angle);
  return vec2(c * way.x - s * way.y, s * way.x + c * way.y);
}

// Whether a mover is at a line of the background, or at its end.
bool reachesMover(vec2 px, Line line) {
  float most = moverAt(px).r;
  for (int side = 0; side < 2; ++side) {
    vec2 at = px + line.shift;
    for (int i = 0; i < kArm; ++i) {
      at += segment * wayOf(line.ways, side, i);
      if (float(i) < line.lengths[side] + 1.0) most = max(most, moverAt(at).r);
    }
  }
  return most > 0.1;
}

struct Arm {
  vec2 ways[kArm];
  float length;
};

Arm walk(vec2 from, vec2 heading, float bend, float most, uint support) {
  Arm arm;
  arm.length = most;
  bool goesOn = true;
  vec2 at = from;
  for (int i = 0; i < kArm; ++i) {
    vec2 way = turned(directionAt(at + 0.5 * segment * heading, support),
                      bend * (float(i) + 0.5) / float(kArm));
    float along = dot(way, heading);
    if (along < 0.0) way = -way;
    if (goesOn && abs(along) < cutOff) {
      goesOn = false;
      arm.length = min(arm.length, float(i));
    }
    arm.ways[i] = way;
    vec2 to = at + segment * way;
    if (goesOn && supportAt(to) != support) {
      bool isEarly = supportAt(at + 0.5 * segment * way) != support;
      // As far as the border, at which it is clipped.
      arm.length = min(arm.length, float(i) + (isEarly ? 0.5 : 1.0));
      goesOn = false;
    }
    at = to;
    heading = way;
  }
  return arm;
}

// Low discrepancy: ranks of neighbouring cells are far apart, so that any tone is even (Roberts,
// "The unreasonable effectiveness of quasirandom sequences", 2018).
float rankOf(vec2 px, uint seed) {
  vec2 cell = floor(px / cellPixels);
  float base = dot(cell, vec2(0.7548776662, 0.5698402910));
  return fract(base + 0.5 * float(seed & 1u) + 0.25 * unitOf(hashOf(seed ^ 0x41u)));
}

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= slots) return;
  uint state = anchors[slot].state;
  if (!isAlive(state)) {
    lines[slot].seen = 0.0;
    return;
  }
  vec2 px = anchors[slot].px;
  uint seed = anchors[slot].seed;
  bool isNew = anew || (state & kBorn) != 0u;
  Line line = lines[slot];
  uint support = line.label;
  if (isNew) {
    line.rank = rankOf(px, seed);
    line.bend = 2.0 * unitOf(hashOf(seed ^ 0x42u)) - 1.0;
  }
  // What is before it has other directions: it stays as it is, and is clipped.
  bool isHeld = !isNew && ((state & (kHidden | kCovered)) != 0u ||
                           (support == 0u && reachesMover(px, line)));
  if (!isHeld) {
    float stray = wander * (2.0 * unitOf(hashOf(seed ^ 0x44u)) - 1.0);
    vec2 heading = turned(directionAt(px, support), stray);
    vec4 jacobian = anchors[slot].jacobian;
    if (!isNew) {
      // Keeps the previous orientation.
      vec2 was = wayOf(line.ways, 0, 0);
      if (dot(jacobian.xy * was.x + jacobian.zw * was.y, heading) < 0.0) heading = -heading;
    }
    vec2 shift = texelFetch(shifts, shiftTexel(int(slot)), 0).xy;
    shift += jitter * (2.0 * unitOf(hashOf(seed ^ 0x45u)) - 1.0) * vec2(-heading.y, heading.x);
    line.shift = shift;
    vec2 from = px + shift;
    float stays = pastOn(support);
    float most = steps * (0.75 + 0.25 * line.bend);
    float bend = stray + 0.5 * wander * line.bend;
    for (int side = 0; side < 2; ++side) {
      Arm arm = walk(from, side == 0 ? heading : -heading, side == 0 ? bend : -bend, most, support);
      vec2 before = side == 0 ? heading : -heading;
      for (int i = 0; i < kArm; ++i) {
        vec2 way = arm.ways[i];
        if (!isNew) way = heldDirection(way, wayOf(line.ways, side, i), jacobian, stays);
        if (dot(way, before) < 0.0) way = -way;
        before = way;
        int at = side * kArm + i;
        line.ways[at >> 2][at & 3] = packSnorm2x16(way);
      }
      line.lengths[side] = isNew ? arm.length : mix(arm.length, line.lengths[side], stays);
    }
  }
  bool isFront = support != 0u;
  float most = toneAt(px + line.shift, isFront);
  for (int side = 0; side < 2; ++side) {
    vec2 at = px + line.shift;
    for (int i = 0; i < kArm; ++i) {
      at += segment * wayOf(line.ways, side, i);
      if (float(i) < line.lengths[side]) most = max(most, toneAt(at, isFront));
    }
  }
  line.seen = anchors[slot].fade * halfWidthOf(most, line.rank);
  lines[slot] = line;
}
