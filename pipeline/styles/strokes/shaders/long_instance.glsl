// Purpose: the drawn form of a long stroke: 16 points, and the width at each.
// Inputs, outputs: px of the full image.
// Precision: highp.
struct Instance {
  vec2 points[16];  // control points of the spline
  float widths[16];  // half of the width at each
  vec4 paint;  // sRGB-coded colour, opacity
  vec4 shape;  // half of the largest width; variant; its object; its rank in [0, 1]
};
