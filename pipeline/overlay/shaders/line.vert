// Purpose: a box around a thick line or a triangle.
// Inputs:  corner of the box (px); the points a, b, c (px; row 0 at the top); half width and kind
//          (overlay::LineShape); outputSize.
// Outputs: the same, for line.frag.
// Precision: highp: px of large pictures.
uniform vec2 outputSize;

layout(location = 0) in vec2 corner;
layout(location = 1) in vec4 firstPoints;
layout(location = 2) in vec4 lastPoint;  // c, half width, 1 for a triangle

flat out highp vec4 ends;
flat out highp vec4 rest;

void main() {
  gl_Position = vec4(2.0 * corner / outputSize - 1.0, 0.0, 1.0);
  ends = firstPoints;
  rest = lastPoint;
}
