// Purpose: the drawn form of a stroke (marks::StrokeSet::instances()).
// Inputs, outputs: px of the full image.
// Precision: highp.
struct Instance {
  vec2 points[8];  // control points of the spline
  vec4 paint;  // sRGB-coded colour, opacity
  vec4 shape;  // half the width; variant, plus 4 if mirrored; its label; its anchor's age
};
