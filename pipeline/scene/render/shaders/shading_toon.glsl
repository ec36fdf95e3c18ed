// Purpose: shading of a model's surface in its light (scene/light/lighting.h) in the three bands of
//          thesis section 3.2.2.
// Inputs:  the light in the camera's frame (scene::setLighting()); colours in linear light.
// Outputs: none. Precision: highp; bands are thresholds.
#include "pipeline/gpu/shaders/colour.glsl"

uniform vec3 towardKey;
uniform vec3 up;
uniform vec3 whiteLight;
uniform float ambientInBands;  // share of ambient light in the light that selects the band
uniform float deepestShade;    // the darkest band's factor; the thesis's is 0.1
uniform vec3 shadeTint;  // factor on sRGB-coded colours where the key light does not reach

float band(float intensity) {
  if (intensity > 0.7) return 1.0;
  if (intensity > 0.2) return 0.4;
  return 0.1;
}

// A white surface in full light is as bright as white paper in the image. The bands' factors
// multiply coded values: 0.4 of the light would look like 0.67. Shade takes the hue of the ambient
// light.
vec3 shaded(vec3 linearRgb, vec3 n, vec3 towardViewer) {
  float b = band(mix(clamp(dot(towardKey, n), 0.0, 1.0), 0.5 + 0.5 * dot(up, n), ambientInBands));
  b = 1.0 - (1.0 - b) * (1.0 - deepestShade) / 0.9;
  vec3 srgb = srgbFromLinear(clamp(linearRgb * whiteLight, 0.0, 1.0));
  return b * (b < 1.0 ? min(srgb * shadeTint, 1.0) : srgb);
}
