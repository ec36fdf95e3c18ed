// Purpose: one instance per stroke, as a strip of equal quads along its spline: for debug views.
// Inputs:  marks::StrokeSet's instances; quads: of the strip.
// Outputs: for the strip's vertex gl_VertexID: its place on the spline and the direction there.
// Precision: highp.
#include "pipeline/marks/strokes/shaders/spline.glsl"
layout(location = 0) in vec4 first;
layout(location = 1) in vec4 second;
layout(location = 2) in vec4 third;
layout(location = 3) in vec4 fourth;
layout(location = 4) in vec4 strokePaint;
layout(location = 5) in vec4 shape;  // half the width, variant, its label, its anchor's age
uniform float quads;

SplinePlace splinePlace() {
  vec2 points[8] = vec2[8](first.xy, first.zw, second.xy, second.zw,
                           third.xy, third.zw, fourth.xy, fourth.zw);
  float s = float(gl_VertexID >> 1) / quads * float(kSplineSpans);
  ivec4 which = splinePointsAt(s);
  return splineAt(s, which, points[which.x], points[which.y], points[which.z], points[which.w]);
}
