// Purpose: toon shading in three bands (thesis section 3.2.2), and what styles need of a surface.
// Inputs:  cameraNormal, triangle; object, srgb (sRGB-coded, which the factors multiply), focus,
//          towardLight (unit, camera frame).
// Outputs: colour RGBA8; ids R32UI; normalFocus RGBA8 (scene/ar_frame.h).
// Precision: highp; bands are thresholds.
uniform uint object;
uniform vec3 srgb;
uniform float focus;
uniform vec3 towardLight;

in vec3 cameraNormal;
flat in uint triangle;

layout(location = 0) out vec4 colour;
layout(location = 1) out uint ids;
layout(location = 2) out vec4 normalFocus;

const uint kTriangleBits = 22u;

float band(float intensity) {
  if (intensity > 0.7) return 1.0;
  if (intensity > 0.2) return 0.4;
  return 0.1;
}

void main() {
  vec3 n = normalize(cameraNormal);
  colour = vec4(band(clamp(dot(towardLight, n), 0.0, 1.0)) * srgb, 1.0);
  ids = object << kTriangleBits | triangle;
  normalFocus = vec4(0.5 * n + 0.5, focus);
}
