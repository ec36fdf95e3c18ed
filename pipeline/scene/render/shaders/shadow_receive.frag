// Purpose: darkens the camera image where models block the light of a plane. Blending multiplies
//          sRGB-coded values, so the share of light is coded too.
// Inputs:  map RG8 (from shadow_blur_down.frag); keyShare, ambientShare: shares of the plane's light
//          per channel.
// Outputs: colour: the factor on the image.
// Precision: highp for positions; colours have 8 bits.
uniform highp sampler2D map;
uniform vec3 keyShare;
uniform vec3 ambientShare;

in vec2 mapPlace;

layout(location = 0) out vec4 colour;

// x to the power of 1 / 2.2, with an error up to 0.011.
vec3 coded(vec3 x) {
  vec3 root = sqrt(x);
  return mix(root, sqrt(root), 0.182);
}

void main() {
  vec2 kept = texture(map, mapPlace).rg;
  vec3 arrives = clamp(1.0 - kept.x * keyShare - kept.y * ambientShare, 0.0, 1.0);
  colour = vec4(coded(arrives), 1.0);
}
