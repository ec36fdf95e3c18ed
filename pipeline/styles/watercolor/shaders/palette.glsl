// Purpose: the paint colour for a colour of the image.
// Inputs:  sRGB-coded colours; `vividness` and `luminosity` in [0, 1] (watercolor_parameters.h).
// Outputs: sRGB-coded colours.
// Precision: mediump suffices.
#include "pipeline/gpu/images/shaders/luma.glsl"
const vec3 kDarkest = vec3(0.10, 0.11, 0.15);  // an indigo, since no pigment is black

// Transparent paint on white: lights open up towards the paper, darks stay coloured.
vec3 painted(vec3 srgb, float vividness, float luminosity) {
  float luma = lumaOf(srgb);
  vec3 vivid = clamp(luma + (srgb - luma) * (1.0 + vividness), 0.0, 1.0);
  vec3 open = 1.0 - (1.0 - vivid) * (1.0 - luminosity * vivid);
  return mix(open, kDarkest + (1.0 - kDarkest) * open, min(1.0, 2.0 * luminosity));
}
