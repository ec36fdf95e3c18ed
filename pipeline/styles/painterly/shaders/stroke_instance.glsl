// Purpose: a stroke as marks::StrokeSet lays it out (marks/shaders/stroke_instances.comp).
// Inputs, outputs: px of the full picture. Precision: highp.
struct Instance {
  vec4 points[4];
  vec4 paint;
  vec4 shape;  // half the width, variant (4 more where it is mirrored), its object, its anchor's age
};

// glDrawArraysIndirect's.
struct DrawCommand {
  uint vertexCount;
  uint instanceCount;
  uint firstVertex;
  uint spare;
};

// Where a stroke's strip is broken into quads, and where its vertices begin.
struct StripPlan {
  uint breaks;  // bit i: at the spline's i-th knot
  uint first;
};

// Each strip's first and last vertex stand twice, so that all are one.
uint stripVertices(uint quads) { return 2u * quads + 4u; }

void pointsOf(vec4 pairs[4], out vec2 points[8]) {
  for (int i = 0; i < 4; ++i) {
    points[2 * i] = pairs[i].xy;
    points[2 * i + 1] = pairs[i].zw;
  }
}
