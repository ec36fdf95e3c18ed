// Purpose: marks a texel of a shadow map; the depth test keeps the lowest surface over it.
// Inputs:  height, 0 … 1.
// Outputs: map RG8: 1 where there is a surface, and its height.
// Precision: 8 bits.
in float height;

layout(location = 0) out vec2 map;

void main() {
  map = vec2(1.0, clamp(height, 0.0, 1.0));
}
