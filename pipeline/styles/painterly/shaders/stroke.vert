// Purpose: a stroke as it is painted. An instance a stroke.
// Inputs:  stroke_spline.glsl's; fullSize: px.
// Outputs: brush: along and across the stroke, in [0, 1] and in the brush's variant; paint; how long the
//          stroke is by its width.
// Precision: highp.
#include "pipeline/styles/painterly/shaders/stroke_spline.glsl"
uniform vec2 fullSize;
out vec2 brush;
flat out vec4 paint;
flat out float aspect;

const float kVariants = 4.0;

void main() {
  SplinePlace place = splinePlace();
  float side = (gl_VertexID & 1) == 0 ? -1.0 : 1.0;
  vec2 across = vec2(-place.along.y, place.along.x);
  // The brush's own round ends go beyond the skeleton's.
  float beyond = place.part == 0.0 ? -1.0 : (place.part >= 1.0 ? 1.0 : 0.0);
  vec2 at = place.at + shape.x * (side * across + 0.6 * beyond * place.along);
  float acrossBrush = 0.5 + 0.5 * (shape.z > 0.5 ? -side : side);
  brush = vec2(place.part, (shape.y + 0.02 + 0.96 * acrossBrush) / kVariants);
  paint = strokePaint;
  aspect = place.length_ / max(2.0 * shape.x, 1.0) + 0.6;
  gl_Position = vec4(2.0 * at / fullSize - 1.0, 0.0, 1.0);
}
