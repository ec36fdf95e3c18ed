// Purpose: toon shading in three bands (thesis section 3.2.2), and what styles need of a surface;
//          shared by surfaces with and without holes.
// Inputs:  cameraNormal, texturePlace, vertexColour, triangle; object, baseColour and baseTexture
//          (sampled as linear light), focus, towardLight (unit, camera frame).
// Outputs: colour RGBA8, sRGB-coded before the band's factor; ids R32UI; normalFocus RGBA8
//          (scene/ar_frame.h).
// Precision: highp; bands are thresholds.
#include "pipeline/gpu/shaders/colour.glsl"
#include "pipeline/scene/shaders/object_id.glsl"

uniform uint object;
uniform vec4 baseColour;
uniform sampler2D baseTexture;
uniform float focus;
uniform vec3 towardLight;

in vec3 cameraNormal;
in vec2 texturePlace;
in vec4 vertexColour;
flat in uint triangle;

layout(location = 0) out vec4 colour;
layout(location = 1) out uint ids;
layout(location = 2) out vec4 normalFocus;

float band(float intensity) {
  if (intensity > 0.7) return 1.0;
  if (intensity > 0.2) return 0.4;
  return 0.1;
}

// Linear light, and coverage.
vec4 surfaceColour() {
  return baseColour * vertexColour * texture(baseTexture, texturePlace);
}

void shade(vec3 linearRgb) {
  vec3 n = normalize(cameraNormal);
  if (!gl_FrontFacing) n = -n;
  vec3 srgb = srgbFromLinear(clamp(linearRgb, 0.0, 1.0));
  colour = vec4(band(clamp(dot(towardLight, n), 0.0, 1.0)) * srgb, 1.0);
  ids = idOf(object, triangle);
  normalFocus = vec4(0.5 * n + 0.5, focus);
}
