// Purpose: debug view of the labels that strokes are clipped at: each in a colour of its own, mixed
//          at borders; the camera image, greyed, where there is none.
// Inputs:  picture; borders (borders.glsl) if hasBorders; size: of the frame.
// Outputs: RGBA8, sRGB-coded, opaque. Precision: highp for places.
#include "pipeline/gpu/shaders/hash.glsl"
#include "pipeline/marks/strokes/shaders/stroke_border.glsl"
uniform sampler2D picture;
uniform highp usampler2D borders;
uniform bool hasBorders;
uniform vec2 size;
layout(location = 0) out vec4 colour;

vec3 colourOf(uint label, vec3 seen) {
  float grey = dot(seen, vec3(0.299, 0.587, 0.114));
  if (label == 0u) return vec3(0.35 * grey);
  vec3 own = vec3(unitOf(hashOf(label)), unitOf(hashOf(label ^ 0x51u)),
                  unitOf(hashOf(label ^ 0x77u)));
  return mix(own, vec3(grey), 0.35);
}

void main() {
  vec3 seen = texture(picture, gl_FragCoord.xy / size).rgb;
  uint border = hasBorders ? texelFetch(borders, ivec2(gl_FragCoord.xy), 0).r : 0u;
  float share = hasBorders ? shareOf(border) : 1.0;
  colour = vec4(mix(colourOf(otherOf(border), seen), colourOf(ownOf(border), seen), share), 1.0);
}
