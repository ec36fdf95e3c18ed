// Purpose: carries the strokes on virtual objects from the previous frame to this one, point by point,
//          each with the surface under it (thesis §5.4 carries a stroke's place only): where a
//          limb bends, a stroke that turned as one would leave it.
// Inputs:  anchors, slots of them; motion (ArFrame) if hasMotion; ids (ArFrame) and their
//          pixelsOfFull; segment: px; arms: 2, of kArm directions each, a uniform, so that
//          compilers keep the loops.
// Outputs: strokes: their directions and girth. One invocation per anchor.
// Precision: highp.
#include "pipeline/marks/anchors/shaders/anchor.glsl"
#include "pipeline/marks/strokes/shaders/stroke.glsl"
#include "pipeline/scene/render/shaders/object_id.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Anchors { Anchor anchors[]; };
layout(std430, binding = 1) buffer Strokes { Stroke strokes[]; };
uniform highp sampler2D motion;
uniform bool hasMotion;
uniform highp usampler2D ids;
uniform vec2 pixelsOfFull;
uniform float segment;
uniform uint slots;
uniform ivec2 arms;

const float kMaxStretch = 1.25;  // in a frame: what moves otherwise is something else
const float kMaxLength = 1.5;    // of a segment, and the inverse of the least

// The motion to the pixel at px, if it shows the object.
bool findMotion(vec2 px, uint object, out vec2 moved) {
  ivec2 pixel = ivec2(floor(px * pixelsOfFull));
  moved = vec2(0.0);
  if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, textureSize(ids, 0)))) return false;
  if (objectOf(texelFetch(ids, pixel, 0).r) != object) return false;
  vec4 found = texelFetch(motion, pixel, 0);
  moved = found.xy / pixelsOfFull;
  return found.w != 0.0;
}

// Where the surface at px in the previous frame is now. `guess`: its displacement.
bool follow(vec2 px, uint object, inout vec2 guess) {
  for (int i = 0; i < 2; ++i) {
    vec2 moved;
    if (!findMotion(px + guess, object, moved)) return false;
    guess = moved;
  }
  return true;
}

// `was`: what it stays where it has collapsed, as on a triangle that is now seen edge-on.
vec2 limited(vec2 direction, vec2 was) {
  float squared = dot(direction, direction);
  if (!(squared > 1e-6)) return was;
  return direction * clamp(1.0, inversesqrt(squared) / kMaxLength, inversesqrt(squared) * kMaxLength);
}

void carryArm(uint slot, int side, uint object) {
  mat2 turn = mat2(anchors[slot].jacobian.xy, anchors[slot].jacobian.zw);
  vec2 moved = anchors[slot].displacement;
  vec2 from = anchors[slot].px - moved;
  float visible = strokes[slot].lengths[side];
  bool isKnown = hasMotion && (anchors[slot].state & kHidden) == 0u;  // else another part would be followed
  for (int i = 0; i < arms.y; ++i) {
    vec2 was = strokes[slot].ways[side * kArm + i];
    vec2 to = from + segment * was;
    vec2 here = moved;
    isKnown = isKnown && float(i) < visible + 1.0 && follow(to, object, moved);
    vec2 now = was + (moved - here) / segment;
    float stretch = length(now) / length(was);
    isKnown = isKnown && stretch < kMaxStretch && stretch > 1.0 / kMaxStretch;
    strokes[slot].ways[side * kArm + i] = limited(isKnown ? now : turn * was, was);
    from = to;
  }
}

// The stretch of the surface across a direction.
float stretchAcross(vec2 along, vec4 jacobian) {
  float area = abs(jacobian.x * jacobian.w - jacobian.y * jacobian.z);
  vec2 unit = normalize(along);
  float stretch = area / max(length(jacobian.xy * unit.x + jacobian.zw * unit.y), 1e-3);
  return stretch < kMaxStretch && stretch > 1.0 / kMaxStretch ? stretch : 1.0;
}

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= slots) return;
  uint state = anchors[slot].state;
  uint object = objectOf(anchors[slot].surface);
  if (!isAlive(state) || (state & kBorn) != 0u || !isVirtual(object)) return;
  float girth = girthOf(strokes[slot].state) *
                stretchAcross(strokes[slot].ways[0], anchors[slot].jacobian);
  strokes[slot].state =
      withGirth(strokes[slot].state, clamp(girth, 1.0 / kMaxLength, kMaxLength));
  for (int side = 0; side < arms.x; ++side) carryArm(slot, side, object);
}
