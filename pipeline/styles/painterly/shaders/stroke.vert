// Purpose: a stroke as a strip of quads along a cubic B-spline whose end points are tripled, so that it
//          begins and ends there (thesis §4.4). An instance a stroke.
// Inputs:  marks::StrokeSet's instances; quads: of the strip, fullSize: px.
// Outputs: brush: along and across the stroke, in [0, 1] and in the brush's variant; paint; and how
//          long the stroke is by its width.
// Precision: highp.
layout(location = 0) in vec4 first;
layout(location = 1) in vec4 second;
layout(location = 2) in vec4 third;
layout(location = 3) in vec4 fourth;
layout(location = 4) in vec4 strokePaint;
layout(location = 5) in vec4 shape;  // half the width, variant, mirrored, quads
uniform float quads;
uniform vec2 fullSize;
out vec2 brush;
out vec4 paint;
flat out float aspect;

const float kVariants = 4.0;
const int kLast = 7;

void main() {
  vec2 points[8] = vec2[8](first.xy, first.zw, second.xy, second.zw, third.xy, third.zw, fourth.xy, fourth.zw);
  float place = float(gl_VertexID >> 1);
  float side = (gl_VertexID & 1) == 0 ? -1.0 : 1.0;
  // A stroke that needs fewer quads ends early; the others have no area.
  float t = min(place / shape.w, 1.0);
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
  along = normalize(along);
  vec2 across = vec2(-along.y, along.x);
  vec2 length_ = points[kLast] - points[0];
  // The brush's own round ends go beyond the skeleton's.
  float beyond = place == 0.0 ? -1.0 : (t >= 1.0 ? 1.0 : 0.0);
  at += shape.x * (side * across + 0.6 * beyond * along);
  float acrossBrush = 0.5 + 0.5 * (shape.z > 0.5 ? -side : side);
  brush = vec2(t, (shape.y + 0.02 + 0.96 * acrossBrush) / kVariants);
  paint = strokePaint;
  aspect = length(length_) / max(2.0 * shape.x, 1.0) + 0.6;
  gl_Position = vec4(2.0 * at / fullSize - 1.0, 0.0, 1.0);
}
