// Purpose: smooth shading of a model's surface in its light (scene/light/lighting.h).
// Inputs:  the light in the camera's frame (scene::setLighting()); colours in linear light.
// Outputs: none. Precision: highp.
#include "pipeline/gpu/shaders/colour.glsl"

uniform vec3 towardKey;
uniform vec3 up;
uniform vec3 keyLight;
uniform vec3 skyLight;
uniform vec3 groundLight;

// Lambert shading under a hemisphere of ambient light and the key light, with a soft gloss
// (normalised Blinn-Phong). Values that a camera would clip keep their hue.
vec3 shaded(vec3 linearRgb, vec3 n, vec3 towardViewer) {
  const float kGloss = 0.04;
  const float kExponent = 24.0;
  float facing = max(dot(towardKey, n), 0.0);
  vec3 ambient = mix(groundLight, skyLight, 0.5 + 0.5 * dot(up, n));
  float glint = pow(max(dot(normalize(towardKey + towardViewer), n), 0.0), kExponent);
  vec3 light = linearRgb * (ambient + keyLight * facing) +
               keyLight * (facing * glint * kGloss * (kExponent + 8.0) / 8.0);
  return srgbFromLinear(light / max(1.0, max(light.r, max(light.g, light.b))));
}
