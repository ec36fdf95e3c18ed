// Purpose: the spline of a stroke, by control points that stay in its instance: with an index that
//          is no constant, a copy of them would have to lie in memory, too.
// Defines: LONG: stroke_strip.glsl's.
// Inputs:  instances; the number of one of them.
// Outputs: functions; px of the full image.
// Precision: highp.
#include "pipeline/styles/strokes/shaders/stroke_strip.glsl"
layout(std430, binding = 0) readonly buffer Instances { Instance instances[]; };

SplinePlace splineAt(uint rank, float s) {
  ivec4 which = splinePointsAt(s);
  return splineAt(s, which, instances[rank].points[which.x], instances[rank].points[which.y],
                  instances[rank].points[which.z], instances[rank].points[which.w]);
}

// Length of the polyline through the points.
float splineLength(uint rank) {
  float sum = 0.0;
  vec2 from = instances[rank].points[0];
  for (int i = 1; i < kSplinePoints; ++i) {
    vec2 to = instances[rank].points[i];
    sum += distance(from, to);
    from = to;
  }
  return sum;
}

#ifdef LONG
// Half of the width at a part of the stroke, in [0, 1].
float halfWidthAt(uint rank, float part) {
  float at = clamp(part, 0.0, 1.0) * 15.0;
  int from = min(int(at), 14);
  return mix(instances[rank].widths[from], instances[rank].widths[from + 1], at - float(from));
}
#endif
