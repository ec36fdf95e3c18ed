// Purpose: a cubic B-spline with tripled end points, so that it begins and ends there (thesis
//          §4.4).
// Defines: LONG: of 16 control points and 17 spans; else of 8 and 9.
// Inputs:  its points; s in [0, kSplineSpans].
// Outputs: the place at s, the direction, and the part of the stroke's length up to it.
// Precision: highp.
#ifdef LONG
const int kSplinePoints = 16;
#else
const int kSplinePoints = 8;
#endif
const int kSplineLast = kSplinePoints - 1;
const int kSplineSpans = kSplinePoints + 1;

struct SplinePlace {
  vec2 at;
  vec2 along;  // unit
  float part;  // of its length, in [0, 1], if its points are evenly spaced
};

int splineSpanAt(float s) { return min(int(s), kSplineSpans - 1); }

// The control points that the place depends on.
ivec4 splinePointsAt(float s) {
  return clamp(splineSpanAt(s) + ivec4(-2, -1, 0, 1), 0, kSplineLast);
}

// c0 to c3: the control points `which`.
SplinePlace splineAt(float s, ivec4 which, vec2 c0, vec2 c1, vec2 c2, vec2 c3) {
  float u = s - float(splineSpanAt(s));
  float v = 1.0 - u;
  vec4 weights = vec4(v * v * v, 3.0 * u * u * u - 6.0 * u * u + 4.0,
                      3.0 * v * v * v - 6.0 * v * v + 4.0, u * u * u) / 6.0;
  vec2 at = weights.x * c0 + weights.y * c1 + weights.z * c2 + weights.w * c3;
  vec2 along = -v * v * c0 + (3.0 * u * u - 4.0 * u) * c1 + (-3.0 * v * v + 4.0 * v) * c2 + u * u * c3;
  // The derivative vanishes at the ends; the direction there is that of the first or last chord.
  if (dot(along, along) < 1e-6) along = c3 - c0;
  if (dot(along, along) < 1e-6) along = vec2(1.0, 0.0);
  return SplinePlace(at, normalize(along), dot(weights, vec4(which)) / float(kSplineLast));
}
