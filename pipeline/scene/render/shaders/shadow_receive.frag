// Purpose: darkens the camera's picture where models keep light off a plane; by multiplying blending
//          of sRGB-coded values, so light's share is coded, too.
// Inputs:  map RG8 (shadow_blur_down.frag's); keyShare, ambientShare: of the plane's light, channel
//          by channel.
// Outputs: colour: what the picture is multiplied by.
// Precision: highp for places; colours have 8 bits.
uniform highp sampler2D map;
uniform vec3 keyShare;
uniform vec3 ambientShare;

in vec2 mapPlace;

layout(location = 0) out vec4 colour;

// x to the power of 1 / 2.2, within 0.011.
vec3 coded(vec3 x) {
  vec3 root = sqrt(x);
  return mix(root, sqrt(root), 0.182);
}

void main() {
  vec2 kept = texture(map, mapPlace).rg;
  vec3 arrives = clamp(1.0 - kept.x * keyShare - kept.y * ambientShare, 0.0, 1.0);
  colour = vec4(coded(arrives), 1.0);
}
