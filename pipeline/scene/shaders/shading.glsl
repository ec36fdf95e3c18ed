// Purpose: how a model's surface looks in the light that falls on it (scene/lighting.h): toon, in
//          the three bands of thesis section 3.2.2, or smooth.
// Inputs:  the light in the camera's frame (scene::setLighting()); colours in linear light.
// Outputs: none. Precision: highp; bands are thresholds.
#include "pipeline/gpu/shaders/colour.glsl"

uniform vec3 towardKey;
uniform vec3 up;
uniform vec3 keyLight;
uniform vec3 skyLight;
uniform vec3 groundLight;
uniform vec3 whiteLight;
uniform float ambientInBands;  // its share of the light that bands are of
uniform float deepestShade;    // the darkest band's factor; the thesis's is 0.1
uniform vec3 shadeTint;  // of sRGB-coded colours that the key light does not reach
uniform int shading;     // scene::Shading

const int kSmooth = 1;

float band(float intensity) {
  if (intensity > 0.7) return 1.0;
  if (intensity > 0.2) return 0.4;
  return 0.1;
}

// White in full light is as white paper is in the picture; the bands' factors multiply coded values
// (METHOD.md, conventions). Shade takes the ambient light's hue.
vec3 toonShaded(vec3 linearRgb, vec3 n) {
  float b = band(mix(clamp(dot(towardKey, n), 0.0, 1.0), 0.5 + 0.5 * dot(up, n), ambientInBands));
  b = 1.0 - (1.0 - b) * (1.0 - deepestShade) / 0.9;
  vec3 srgb = srgbFromLinear(clamp(linearRgb * whiteLight, 0.0, 1.0));
  return b * (b < 1.0 ? min(srgb * shadeTint, 1.0) : srgb);
}

// Lambert under a hemisphere of ambient light and the key light, with a soft gloss (Blinn-Phong,
// normalised). What a camera would clip keeps its hue.
vec3 smoothShaded(vec3 linearRgb, vec3 n, vec3 towardViewer) {
  const float kGloss = 0.04;
  const float kExponent = 24.0;
  float facing = max(dot(towardKey, n), 0.0);
  vec3 ambient = mix(groundLight, skyLight, 0.5 + 0.5 * dot(up, n));
  float glint = pow(max(dot(normalize(towardKey + towardViewer), n), 0.0), kExponent);
  vec3 light = linearRgb * (ambient + keyLight * facing) +
               keyLight * (facing * glint * kGloss * (kExponent + 8.0) / 8.0);
  return srgbFromLinear(light / max(1.0, max(light.r, max(light.g, light.b))));
}

vec3 shaded(vec3 linearRgb, vec3 n, vec3 towardViewer) {
  return shading == kSmooth ? smoothShaded(linearRgb, n, towardViewer) : toonShaded(linearRgb, n);
}
