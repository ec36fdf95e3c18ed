// Purpose: the drawn form of each stroke: the control points of its spline, in painting order.
// Inputs:  anchors, strokes, ranks (stroke_order.comp); segment: px; width: px, widthSpread: random
//          part of it; opacity; leaveLight; mixture.glsl's if isLimited; fidelity.glsl's; jitter: of hue,
//          saturation, value.
// Outputs: instances: 8 points (px of the full image), colour (sRGB-coded) and opacity; half the
//          width (px), the brush's variant, plus 4 if it is mirrored, the label of what the stroke
//          lies on (surface_form.glsl), its anchor's age (s). One invocation per anchor.
// Precision: highp.
#include "pipeline/gpu/shaders/hash.glsl"
#include "pipeline/gpu/images/shaders/luma.glsl"
#include "pipeline/marks/anchors/shaders/anchor.glsl"
#include "pipeline/marks/shaders/fidelity.glsl"
#include "pipeline/marks/shaders/mixture.glsl"
#include "pipeline/marks/strokes/shaders/stroke.glsl"
#include "pipeline/marks/strokes/shaders/stroke_instance.glsl"
#include "pipeline/marks/strokes/shaders/stroke_label.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Anchors { Anchor anchors[]; };
layout(std430, binding = 1) readonly buffer Strokes { Stroke strokes[]; };
layout(std430, binding = 2) readonly buffer Ranks { uint ranks[]; };
// volatile: docs/gpu.md, rule 22
layout(std430, binding = 3) volatile writeonly buffer Instances { Instance instances[]; };
uniform uint slots;
uniform float segment;
uniform float width;
uniform float widthSpread;
uniform float opacity;
uniform float leaveLight;
uniform bool isLimited;
uniform vec3 jitter;
uniform int points;  // 8; a uniform, so that compilers keep the loop over them

const float kGreyHue = 0.4;
const float kModelValues = 0.5;  // of the jitter: models turn, which shows it more
const float kSpeck = 0.5;
const float kFaithfulJitter = 0.25;  // of the jitter, where fidelity is 1
const float kFaithfulSpeck = 0.4;    // of what is a speck

// The point `s` segments along the stroke, from its anchor on.
vec2 along(uint slot, float s) {
  int first = s >= 0.0 ? 0 : kArm;
  vec2 at = vec2(0.0);
  for (int i = 0; i < kArm; ++i) {
    at += strokes[slot].ways[first + i] * clamp(abs(s) - float(i), 0.0, 1.0);
  }
  return at;
}

float randomOf(uint seed, uint salt) { return unitOf(hashOf(seed ^ salt)) - 0.5; }

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= slots) return;
  uint rank = ranks[slot];
  if (rank == 0xFFFFFFFFu) return;
  uint seed = anchors[slot].seed;
  vec2 px = anchors[slot].px;
  // A stroke that fades in or out also grows or shrinks.
  float grown = mix(0.35, 1.0, strokes[slot].seen);
  // Lengths vary randomly, but never beyond the traced end.
  vec2 lengths = strokes[slot].lengths * grown * (0.875 + 0.25 * randomOf(seed, 0x3u));
  float wide = width * girthOf(strokes[slot].state) * (1.0 + widthSpread * 2.0 * randomOf(seed, 0x11u)) * mix(0.6, 1.0, strokes[slot].seen);
  lengths = max(lengths, vec2(0.3 * wide / segment));  // a dab, not a speck
  for (int i = points; i > 0; --i) {
    float s = mix(-lengths.y, lengths.x, float(i - 1) / float(points - 1));
    instances[rank].points[i - 1] = px + segment * along(slot, s);
  }
  vec3 colour = strokes[slot].colour;
  bool isOnModel = isPatch(labelOfStroke(strokes[slot].state));
  vec3 jitters = jitter * (isOnModel ? 1.0 : mix(1.0, kFaithfulJitter, fidelityAt(px)));
  float luma = lumaOf(colour);
  vec3 hue = vec3(randomOf(seed, 0x21u), randomOf(seed, 0x22u), randomOf(seed, 0x23u));
  hue -= lumaOf(hue);
  colour = luma + (colour - luma) * (1.0 + 2.0 * jitters.y * randomOf(seed, 0x24u));
  // Jitter leaves greys nearly grey.
  float chroma = max(colour.r, max(colour.g, colour.b)) - min(colour.r, min(colour.g, colour.b));
  colour += 2.0 * jitters.x * hue * (0.25 + luma) * mix(kGreyHue, 1.0, smoothstep(0.0, 0.25, chroma));
  float values = jitters.z * (isOnModel ? kModelValues : 1.0);
  colour *= 1.0 + 2.0 * values * randomOf(seed, 0x25u);
  float light = smoothstep(0.2, 0.95, luma);
  // A stroke cut short on both sides is a speck with little support: paint it thinly.
  float shorter = isOnModel ? 1.0 : mix(1.0, kFaithfulSpeck, fidelityOf(strokes[slot].state));
  float length_ = strokes[slot].lengths.x + strokes[slot].lengths.y;
  float stands = mix(kSpeck, 1.0, smoothstep(0.8 * shorter, 2.2 * shorter, length_));
  colour = clamp(colour, 0.0, 1.0);
  if (isLimited) colour = mixtureOf(colour);
  instances[rank].paint.xyz = colour;
  instances[rank].paint.w = opacity * stands * (1.0 - leaveLight * light) * strokes[slot].seen;
  instances[rank].shape.xy = vec2(0.5 * wide, float(hashOf(seed ^ 0x31u) & 7u));
  instances[rank].shape.zw =
      vec2(float(labelOfStroke(strokes[slot].state)), ageOf(anchors[slot].ageAndRank));
}
