// Purpose: the guide: the image at half size in the colours of the paint, with small details
//          smoothed away. It decides where one wash ends and the next begins, so that shapes are
//          rounded as by a brush.
// Inputs:  picture (RGBA8, sRGB-coded, LINEAR), texel (1 / its size), reach: px of the image;
//          palette.glsl's.
// Outputs: RGBA8: sRGB-coded colour.
// Precision: highp for places.
uniform sampler2D picture;
uniform vec2 texel;
uniform float reach;
uniform float vividness;
uniform float luminosity;
#include "pipeline/styles/watercolor/shaders/palette.glsl"
layout(location = 0) out vec4 guide;

void main() {
  vec2 at = 2.0 * gl_FragCoord.xy;
  vec3 sum = 4.0 * texture(picture, at * texel).rgb;
  sum += texture(picture, (at + vec2(-reach, -reach)) * texel).rgb;
  sum += texture(picture, (at + vec2(reach, -reach)) * texel).rgb;
  sum += texture(picture, (at + vec2(-reach, reach)) * texel).rgb;
  sum += texture(picture, (at + vec2(reach, reach)) * texel).rgb;
  sum += 2.0 * texture(picture, (at + vec2(-1.41 * reach, 0.0)) * texel).rgb;
  sum += 2.0 * texture(picture, (at + vec2(1.41 * reach, 0.0)) * texel).rgb;
  sum += 2.0 * texture(picture, (at + vec2(0.0, -1.41 * reach)) * texel).rgb;
  sum += 2.0 * texture(picture, (at + vec2(0.0, 1.41 * reach)) * texel).rgb;
  guide = vec4(painted(sum * (1.0 / 16.0), vividness, luminosity), 1.0);
}
