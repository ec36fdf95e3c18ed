// Purpose: a thick line with round ends, or a filled triangle, with a dark casing: two passes, the casings first.
// Inputs:  those of line.vert; isCasing: 1 in the first pass; casingPx: its width; opacity.
// Outputs: RGBA8, alpha premultiplied. Precision: highp for distances.
#include "pipeline/overlay/shaders/marking.glsl"

uniform float casingPx;
uniform int isCasing;
uniform float opacity;

flat in highp vec4 ends;
flat in highp vec4 rest;

layout(location = 0) out vec4 colour;

float toLine(vec2 p, vec2 a, vec2 b) {
  vec2 way = b - a;
  float t = clamp(dot(p - a, way) / max(dot(way, way), 1e-6), 0.0, 1.0);
  return length(p - a - t * way);
}

float turn(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }

// Negative inside.
float toTriangle(vec2 p, vec2 a, vec2 b, vec2 c) {
  float outside = min(toLine(p, a, b), min(toLine(p, b, c), toLine(p, c, a)));
  float s = turn(b - a, p - a), t = turn(c - b, p - b), u = turn(a - c, p - c);
  bool isIn = (s >= 0.0 && t >= 0.0 && u >= 0.0) || (s <= 0.0 && t <= 0.0 && u <= 0.0);
  return isIn ? -outside : outside;
}

void main() {
  vec2 p = gl_FragCoord.xy;
  float away = rest.w > 0.5 ? toTriangle(p, ends.xy, ends.zw, rest.xy) : toLine(p, ends.xy, ends.zw);
  away -= rest.z;
  if (isCasing == 1) away -= casingPx;
  float coverage = clamp(0.5 - away, 0.0, 1.0) * opacity;
  vec3 rgb = isCasing == 1 ? kCasing : kReserved;
  colour = vec4(rgb * coverage, coverage);
}
