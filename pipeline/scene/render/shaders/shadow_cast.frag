// Purpose: marks a texel of a shadow's map; by the depth test, with the lowest thing over it.
// Inputs:  height, 0 … 1.
// Outputs: map RG8: 1 where something is, and its height.
// Precision: 8 bits.
in float height;

layout(location = 0) out vec2 map;

void main() {
  map = vec2(1.0, clamp(height, 0.0, 1.0));
}
