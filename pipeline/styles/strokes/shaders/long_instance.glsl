// Purpose: the drawn form of a long stroke: 16 points, and the width at each.
// Inputs, outputs: px of the full image.
// Precision: highp.
struct Instance {
  vec4 points[8];  // two control points of the spline each
  vec4 widths[4];  // half of the width at four of them each
  vec4 paint;      // sRGB-coded colour, opacity
  vec4 shape;      // half of the largest width; variant; its object; its rank in [0, 1]
};

// Half of the width at a part of the stroke, in [0, 1].
float halfWidthAt(vec4 widths[4], float part) {
  float at = clamp(part, 0.0, 1.0) * 15.0;
  int from = min(int(at), 14);
  int to = from + 1;
  return mix(widths[from >> 2][from & 3], widths[to >> 2][to & 3], at - float(from));
}
