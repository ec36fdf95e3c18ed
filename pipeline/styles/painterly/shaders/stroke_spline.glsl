// Purpose: a stroke as a strip of quads along a cubic B-spline whose end points are tripled, so that it
//          begins and ends there (thesis §4.4): 8 control points, 9 spans.
// Inputs:  marks::StrokeSet's instances; quads: of the strip.
// Outputs: of the strip's vertex gl_VertexID: its place on the spline and the direction there.
// Precision: highp.
layout(location = 0) in vec4 first;
layout(location = 1) in vec4 second;
layout(location = 2) in vec4 third;
layout(location = 3) in vec4 fourth;
layout(location = 4) in vec4 strokePaint;
layout(location = 5) in vec4 shape;  // half the width, variant, mirrored, its anchor's age
uniform float quads;

const int kLast = 7;

struct SplinePlace {
  vec2 at;
  vec2 along;    // unit
  float part;    // of the strip, in [0, 1]
  float length_; // of the chord, px
};

SplinePlace splinePlace() {
  vec2 points[8] = vec2[8](first.xy, first.zw, second.xy, second.zw, third.xy, third.zw, fourth.xy, fourth.zw);
  float t = float(gl_VertexID >> 1) / quads;
  float s = t * float(kLast + 2);
  int span = min(int(s), kLast + 1);
  float u = s - float(span);
  vec2 c0 = points[clamp(span - 2, 0, kLast)];
  vec2 c1 = points[clamp(span - 1, 0, kLast)];
  vec2 c2 = points[clamp(span, 0, kLast)];
  vec2 c3 = points[clamp(span + 1, 0, kLast)];
  float v = 1.0 - u;
  vec2 at = (v * v * v * c0 + (3.0 * u * u * u - 6.0 * u * u + 4.0) * c1 +
             (3.0 * v * v * v - 6.0 * v * v + 4.0) * c2 + u * u * u * c3) / 6.0;
  // At the very ends the spline stands still; its direction there is the first or last span's.
  vec2 along = -v * v * c0 + (3.0 * u * u - 4.0 * u) * c1 + (-3.0 * v * v + 4.0 * v) * c2 + u * u * c3;
  if (dot(along, along) < 1e-6) along = points[min(span, kLast)] - points[max(span - 3, 0)];
  if (dot(along, along) < 1e-6) along = vec2(1.0, 0.0);
  return SplinePlace(at, normalize(along), t, distance(points[kLast], points[0]));
}
