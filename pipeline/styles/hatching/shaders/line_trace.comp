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
#include "pipeline/marks/anchors/shaders/anchor.glsl"
#include "pipeline/marks/strokes/shaders/stroke_history.glsl"
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
uniform ivec2 arms;  // 2, of kArm segments each; a uniform, so that compilers keep the loops

vec2 turned(vec2 way, float angle) {
  float c = cos(angle);
  float s = sin(angle);
  return vec2(c * way.x - s * way.y, s * way.x + c * way.y);
}

vec2 wayOf(uint slot, int arm, int i) {
  int at = arm * kArm + i;
  return unpackSnorm2x16(lines[slot].ways[at >> 2][at & 3]);
}

// Whether a mover is at a line of the background, or at its end.
bool reachesMover(uint slot, vec2 px) {
  vec2 from = px + lines[slot].shift;
  float most = moverAt(px).r;
  for (int side = 0; side < arms.x; ++side) {
    float reach = min(lines[slot].lengths[side] + 1.0, float(kArm));
    vec2 at = from;
    for (int i = 0; float(i) < reach; ++i) {
      at += segment * wayOf(slot, side, i);
      most = max(most, moverAt(at).r);
    }
  }
  return most > 0.1;
}

// Low discrepancy: ranks of neighbouring cells are far apart, so that any tone is even (Roberts,
// "The unreasonable effectiveness of quasirandom sequences", 2018).
float rankOf(vec2 px, uint seed) {
  vec2 cell = floor(px / cellPixels);
  float base = dot(cell, vec2(0.7548776662, 0.5698402910));
  return fract(base + 0.5 * float(seed & 1u) + 0.25 * unitOf(hashOf(seed ^ 0x41u)));
}

// Walks one arm from the line's middle, and blends it with its past as it goes.
void traceArm(uint slot, int side, vec2 from, vec2 heading, float bend, float most, bool isNew,
              uint support) {
  vec4 jacobian = anchors[slot].jacobian;
  float stays = pastOn(support);
  float reach = most;  // segments
  bool goesOn = true;
  vec2 at = from;
  vec2 before = heading;  // of the blended ones
  for (int i = 0; i < arms.y; ++i) {
    vec2 way = turned(directionAt(at + 0.5 * segment * heading, support),
                      bend * (float(i) + 0.5) / float(kArm));
    float along = dot(way, heading);
    if (along < 0.0) way = -way;
    if (goesOn && abs(along) < cutOff) {
      goesOn = false;
      reach = min(reach, float(i));
    }
    vec2 to = at + segment * way;
    if (goesOn && supportAt(to) != support) {
      bool isEarly = supportAt(at + 0.5 * segment * way) != support;
      // As far as the border, at which it is clipped.
      reach = min(reach, float(i) + (isEarly ? 0.5 : 1.0));
      goesOn = false;
    }
    at = to;
    heading = way;
    if (!isNew) way = heldDirection(way, wayOf(slot, side, i), jacobian, stays);
    if (dot(way, before) < 0.0) way = -way;
    before = way;
    int place = side * kArm + i;
    lines[slot].ways[place >> 2][place & 3] = packSnorm2x16(way);
  }
  lines[slot].lengths[side] = isNew ? reach : mix(reach, lines[slot].lengths[side], stays);
}

void trace(uint slot, vec2 px, uint seed, bool isNew, uint support) {
  float stray = wander * (2.0 * unitOf(hashOf(seed ^ 0x44u)) - 1.0);
  vec2 straight = directionAt(px, support);
  vec2 heading = turned(straight, stray);
  vec2 held = straight;
  if (!isNew) {
    // Keeps the previous orientation: of the heading that the first segment is compared with.
    vec4 jacobian = anchors[slot].jacobian;
    vec2 was = wayOf(slot, 0, 0);
    if (dot(jacobian.xy * was.x + jacobian.zw * was.y, heading) < 0.0) heading = -heading;
    held = heldDirection(heading, was, jacobian, pastOn(support));
  }
  vec2 shift = texelFetch(shifts, shiftTexel(int(slot)), 0).xy;
  shift += jitter * (2.0 * unitOf(hashOf(seed ^ 0x45u)) - 1.0) * vec2(-held.y, held.x);
  lines[slot].shift = shift;
  float strays = lines[slot].bend;
  float most = steps * (0.75 + 0.25 * strays);
  float bend = stray + 0.5 * wander * strays;
  for (int side = 0; side < arms.x; ++side) {
    float sense = side == 0 ? 1.0 : -1.0;
    traceArm(slot, side, px + shift, sense * heading, sense * bend, most, isNew, support);
  }
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
  uint support = lines[slot].label;
  if (isNew) {
    lines[slot].rank = rankOf(px, seed);
    lines[slot].bend = 2.0 * unitOf(hashOf(seed ^ 0x42u)) - 1.0;
  }
  // What is before it has other directions: it stays as it is, and is clipped.
  bool isHeld = !isNew && ((state & (kHidden | kCovered)) != 0u ||
                           (support == 0u && reachesMover(slot, px)));
  if (!isHeld) trace(slot, px, seed, isNew, support);
  bool isFront = support != 0u;
  bool isModel = isFront && support != kMoverLabel;
  vec2 from = px + lines[slot].shift;
  float most = toneAt(from, isFront, isModel);
  for (int side = 0; side < arms.x; ++side) {
    float reach = min(lines[slot].lengths[side], float(kArm));
    vec2 at = from;
    for (int i = 0; float(i) < reach; ++i) {
      at += segment * wayOf(slot, side, i);
      most = max(most, toneAt(at, isFront, isModel));
    }
  }
  lines[slot].seen = anchors[slot].fade * halfWidthOf(most, lines[slot].rank);
}
