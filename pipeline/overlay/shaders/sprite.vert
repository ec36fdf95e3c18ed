// Purpose: a picture's rectangle, from the vertex number alone.
// Inputs:  origin and size (px; row 0 at the top), outputSize.
// Outputs: the position. Precision: highp: px of large pictures.
uniform vec2 origin;
uniform vec2 size;
uniform vec2 outputSize;

void main() {
  vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1));
  gl_Position = vec4(2.0 * (origin + corner * size) / outputSize - 1.0, 0.0, 1.0);
}
