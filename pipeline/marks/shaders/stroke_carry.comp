// Purpose: carries the strokes on virtual objects from the previous frame to this one, point by point,
//          each with the surface under it (thesis §5.4 carries a stroke's place only): where a
//          limb bends, a stroke that turned as one would leave it.
// Inputs:  anchors, slots of them; motion (ArFrame) if hasMotion; ids (ArFrame) and their
//          pixelsOfFull; segment: px.
// Outputs: strokes: their directions and girth. One invocation per anchor.
// Precision: highp.
#include "pipeline/marks/shaders/anchor.glsl"
#include "pipeline/marks/shaders/stroke.glsl"
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

vec4[2] carriedArm(vec4 was[2], float visible, Anchor anchor, uint object) {
  vec2 before[kArm] = vec2[kArm](was[0].xy, was[0].zw, was[1].xy, was[1].zw);
  mat2 turn = mat2(anchor.jacobian.xy, anchor.jacobian.zw);
  vec2 from = anchor.px - anchor.displacement;
  vec2 moved = anchor.displacement;
  bool isKnown = hasMotion && (anchor.state & kHidden) == 0u;  // else another part would be followed
  for (int i = 0; i < kArm; ++i) {
    vec2 to = from + segment * before[i];
    vec2 here = moved;
    isKnown = isKnown && float(i) < visible + 1.0 && follow(to, object, moved);
    vec2 now = before[i] + (moved - here) / segment;
    float stretch = length(now) / length(before[i]);
    isKnown = isKnown && stretch < kMaxStretch && stretch > 1.0 / kMaxStretch;
    before[i] = limited(isKnown ? now : turn * before[i], before[i]);
    from = to;
  }
  return vec4[2](vec4(before[0], before[1]), vec4(before[2], before[3]));
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
  Stroke stroke = strokes[slot];
  float girth = girthOf(stroke.state) * stretchAcross(stroke.ahead[0].xy, anchors[slot].jacobian);
  strokes[slot].state = withGirth(stroke.state, clamp(girth, 1.0 / kMaxLength, kMaxLength));
  strokes[slot].ahead = carriedArm(stroke.ahead, stroke.lengths.x, anchors[slot], object);
  strokes[slot].behind = carriedArm(stroke.behind, stroke.lengths.y, anchors[slot], object);
}
