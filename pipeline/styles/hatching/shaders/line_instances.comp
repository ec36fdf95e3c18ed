// Purpose: the drawn form of each line: the control points of its spline, and its width at each:
//          what the tone there asks for, less where the pen is set down and lifted.
// Inputs:  anchors, lines, ranks (line_order.comp); tone.glsl's; segment: px; taper: the part of
//          a line on each side in which it thins out; paint: colour and opacity; colours: the
//          image (LINEAR), colour: how much of it the paint takes; mover_labels.glsl's, background
//          (marks::MotionLayers): the colour behind movers; rankColour: how much a line is
//          coloured by its rank, for views.
// Outputs: instances (long_instance.glsl). One invocation per anchor.
// Precision: highp.
#include "pipeline/gpu/shaders/hash.glsl"
#include "pipeline/marks/anchors/shaders/anchor.glsl"
#include "pipeline/marks/movers/shaders/mover_labels.glsl"
#include "pipeline/scene/render/shaders/surface_form.glsl"
#include "pipeline/styles/hatching/shaders/line.glsl"
#include "pipeline/styles/strokes/shaders/long_instance.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Anchors { Anchor anchors[]; };
layout(std430, binding = 1) readonly buffer Lines { Line lines[]; };
layout(std430, binding = 2) readonly buffer Ranks { uint ranks[]; };
// volatile: docs/gpu.md, rule 22
layout(std430, binding = 3) volatile writeonly buffer Instances { Instance instances[]; };
#include "pipeline/styles/hatching/shaders/tone.glsl"
uniform uint slots;
uniform float segment;
uniform float taper;
uniform vec4 paint;
uniform float rankColour;
uniform sampler2D colours;
uniform float colour;
uniform highp sampler2D background;
uniform int points;  // 16; a uniform, so that compilers keep the loop over them

vec2 wayOf(uint slot, int arm, int i) {
  int at = arm * kArm + i;
  return unpackSnorm2x16(lines[slot].ways[at >> 2][at & 3]);
}

// The colour of what a line lies on: that of the remembered background where a mover covers the
// middle of a line behind it, and that at the anchor where the middle of a mover's line is beside it.
vec3 colourOf(vec2 px, vec2 middle, uint support) {
  float mover = moverAt(middle).r;
  vec3 seen = textureLod(colours, middle / fullSize, 0.0).rgb;
  if (support == kMoverLabel) {
    vec3 atAnchor = textureLod(colours, px / fullSize, 0.0).rgb;
    return mix(atAnchor, seen, smoothstep(0.3, 0.7, mover));
  }
  if (support != 0u || mover <= 0.0) return seen;
  vec4 behind = textureLod(background, inLayers(background, middle), 0.0);
  return mix(seen, behind.rgb, smoothstep(0.0, 0.3, mover) * step(1.0, behind.a));
}

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= slots) return;
  uint place = ranks[slot];
  if (place == 0xFFFFFFFFu) return;
  vec2 lengths = lines[slot].lengths;
  float rank = lines[slot].rank;
  uint label = lines[slot].label;
  bool isFront = label != 0u;
  bool isModel = isFront && label != kMoverLabel;
  // Lines are clipped at the border between two movers.
  if (label == kMoverLabel) label = labelOfMover(moverOf(anchors[slot].state));
  float fade = anchors[slot].fade;
  vec2 from = anchors[slot].px + lines[slot].shift;
  float widest = 0.0;
  for (int i = 0; i < points; ++i) {
    float part = float(i) / float(points - 1);
    float s = mix(-lengths.y, lengths.x, part);
    int arm = s < 0.0 ? 1 : 0;
    float way = abs(s);
    vec2 at = from;
    for (int k = 0; k < kArm && float(k) < way; ++k) {
      at += segment * min(way - float(k), 1.0) * wayOf(slot, arm, k);
    }
    instances[place].points[i] = at;
    float fromEnd = min(part, 1.0 - part);
    float pressure = smoothstep(-0.02, max(taper, 1e-3), fromEnd);
    float wide = fade * pressure * halfWidthOf(toneAt(at, isFront, isModel), rank);
    instances[place].widths[i] = wide;
    widest = max(widest, wide);
  }
  vec3 byRank = mix(vec3(0.9, 0.15, 0.1), vec3(0.1, 0.3, 0.95), rank);
  vec3 ink = paint.rgb;
  if (colour > 0.0) {
    ink = mix(ink, colourOf(anchors[slot].px, from, lines[slot].label), colour);
  }
  instances[place].paint.rgb = mix(ink, byRank, rankColour);
  instances[place].paint.a = paint.a;
  float variant = float(hashOf(anchors[slot].seed ^ 0x31u) & 3u);
  instances[place].shape.xy = vec2(widest, variant);
  instances[place].shape.zw = vec2(float(label), rank);
}
