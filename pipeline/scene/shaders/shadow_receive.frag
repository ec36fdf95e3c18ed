// Purpose: darkens the camera's picture where models keep light off a plane; by multiplying blending
//          of sRGB-coded values, so light's share is coded, too.
// Inputs:  map RG8 (shadow_blur_down.frag's); keyShare, ambientShare: of the plane's light, channel
//          by channel.
// Outputs: colour: what the picture is multiplied by; ids R32UI: 0, the camera; normalFocus: 1,
//          which leaves what is there.
// Precision: highp for places; colours have 8 bits.
uniform sampler2D map;
uniform vec3 keyShare;
uniform vec3 ambientShare;

in vec2 mapPlace;

layout(location = 0) out vec4 colour;
layout(location = 1) out uint ids;
layout(location = 2) out vec4 normalFocus;

void main() {
  vec2 kept = texture(map, mapPlace).rg;
  vec3 arrives = clamp(1.0 - kept.x * keyShare - kept.y * ambientShare, 0.0, 1.0);
  colour = vec4(pow(arrives, vec3(1.0 / 2.2)), 1.0);
  ids = 0u;
  normalFocus = vec4(1.0);
}
