// Purpose: the drawn form of each line: the control points of its spline, and its width at each:
//          what the tone there asks for, less where the pen is set down and lifted.
// Inputs:  anchors, lines, ranks (line_order.comp); tone.glsl's; segment: px; taper: the part of
//          a line on each side in which it thins out; paint: colour and opacity; colours: the
//          image (LINEAR), colour: how much of it the paint takes; rankColour: how much a line is
//          coloured by its rank, for views.
// Outputs: instances (long_instance.glsl). One invocation per anchor.
// Precision: highp.
#include "pipeline/gpu/shaders/hash.glsl"
#include "pipeline/marks/shaders/anchor.glsl"
#include "pipeline/styles/hatching/shaders/line.glsl"
#include "pipeline/styles/strokes/shaders/long_instance.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Anchors { Anchor anchors[]; };
layout(std430, binding = 1) readonly buffer Lines { Line lines[]; };
layout(std430, binding = 2) readonly buffer Ranks { uint ranks[]; };
layout(std430, binding = 3) writeonly buffer Instances { Instance instances[]; };
#include "pipeline/styles/hatching/shaders/tone.glsl"
uniform uint slots;
uniform float segment;
uniform float taper;
uniform vec4 paint;
uniform float rankColour;
uniform sampler2D colours;
uniform float colour;

const int kPoints = 16;

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= slots) return;
  uint place = ranks[slot];
  if (place == 0xFFFFFFFFu) return;
  Line line = lines[slot];
  bool isFront = line.label != 0u;
  vec2 from = anchors[slot].px + line.shift;
  Instance made;
  float widest = 0.0;
  int arm = 1;
  vec2 points[kPoints];
  for (int i = 0; i < kPoints; ++i) {
    float part = float(i) / float(kPoints - 1);
    float s = mix(-line.lengths.y, line.lengths.x, part);
    arm = s < 0.0 ? 1 : 0;
    float way = abs(s);
    vec2 at = from;
    for (int k = 0; k < kArm; ++k) {
      at += segment * clamp(way - float(k), 0.0, 1.0) * wayOf(line.ways, arm, k);
    }
    points[i] = at;
    float fromEnd = min(part, 1.0 - part);
    float pressure = smoothstep(-0.02, max(taper, 1e-3), fromEnd);
    float wide = anchors[slot].fade * pressure * halfWidthOf(toneAt(at, isFront), line.rank);
    made.widths[i >> 2][i & 3] = wide;
    widest = max(widest, wide);
  }
  for (int i = 0; i < 8; ++i) made.points[i] = vec4(points[2 * i], points[2 * i + 1]);
  vec3 byRank = mix(vec3(0.9, 0.15, 0.1), vec3(0.1, 0.3, 0.95), line.rank);
  vec3 ink = mix(paint.rgb, textureLod(colours, from / fullSize, 0.0).rgb, colour);
  made.paint = vec4(mix(ink, byRank, rankColour), paint.a);
  made.shape = vec4(widest, float(hashOf(anchors[slot].seed ^ 0x31u) & 3u), float(line.label),
                    line.rank);
  instances[place] = made;
}
