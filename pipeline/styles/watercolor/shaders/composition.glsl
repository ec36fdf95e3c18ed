// Purpose: washes on paper, per pixel: a light wash, a dark one glazed over it where the image is
//          dark, lines (thesis §3.2.2) and the substrate (§3.5).
// Inputs:  tiling, darkLayer and lightLayer (layers.frag), gliding (gliding.frag), all LINEAR; substrate.glsl's; pictureSize,
//          threshold, and the parameters of the same names (watercolor_parameters.h).
// Outputs: sRGB-coded colours.
// Precision: highp for places; less would suffice for colours.
#include "pipeline/gpu/images/shaders/luma.glsl"
#include "pipeline/styles/watercolor/shaders/density.glsl"
#include "pipeline/styles/substrate/shaders/substrate.glsl"
#include "pipeline/styles/watercolor/shaders/tiling_word.glsl"
uniform highp usampler2D tiling;
uniform sampler2D darkLayer;
uniform sampler2D lightLayer;
uniform sampler2D gliding;
uniform vec2 pictureSize;
uniform float threshold;
uniform float edgeSoftness;
uniform float edgeDarkness;
uniform float wobble;
uniform float rim;
uniform float granulation;
uniform float grain;

// Applies the substrate's relief and its warm white.
vec3 onSubstrate(vec3 colour, vec4 substrate) {
  return colour * (1.0 + grain * (substrate.g - 0.5)) * mix(vec3(1.0), vec3(1.0, 0.992, 0.97), grain);
}

// Darkness of the line, from 0 to 1.
float lineAt(ivec2 p, float valley) {
  // Four pixels in one read; their mean smooths the steps of the line.
  uvec4 words = textureGather(tiling, (vec2(p) + 1.0) / pictureSize);
  vec4 roots = vec4(words >> 24u) * (1.0 / 255.0);
  float strength = 0.25 * dot(roots, roots);
  float line = smoothstep(threshold * (1.0 - edgeSoftness), threshold * (1.0 + 2.0 * edgeSoftness),
                          strength);
  return clamp(edgeDarkness * line * (0.8 + 0.8 * valley), 0.0, 1.0);
}

// The paint on pixel p. The paper does nothing to paint that glides over it.
vec3 washAt(ivec2 p, vec4 substrate) {
  float stays = 1.0 - texture(gliding, (vec2(p) + 0.5) / pictureSize).r;
  float valley = stays * (0.5 - substrate.r);
  vec2 at = (vec2(p) + 0.5 + stays * wobble * (substrate.ba - 0.5)) / pictureSize;
  vec4 dark = texture(darkLayer, at);
  vec4 light = texture(lightLayer, at);
  float place = 2.0 * dark.a - 0.5;
  float hard = light.a;

  // The coverage of the dark glaze here, and the dark rim where it has dried.
  float sharp = smoothstep(0.34, 0.66, place + 0.25 * hard * valley);
  float glaze = 1.0 - mix(clamp(place, 0.0, 1.0), sharp, hard);
  float atRim = hard * smoothstep(0.05, 0.42, place) * glaze;
  vec3 lightDensity = unpackDensity(light.rgb);
  vec3 glazeDensity = unpackDensity(dark.rgb) - lightDensity;
  vec3 density = lightDensity + glazeDensity * glaze * (1.0 + mix(0.25, 1.0, stays) * rim * atRim);

  // Pigment settles in the valleys, less visibly in thick paint; a brush skips the highest grains.
  float thick = lumaOf(density);
  float grains = 2.0 * valley / (1.0 + 0.7 * thick) -
                 0.5 * stays * smoothstep(0.55, 0.9, substrate.r) * smoothstep(1.0, 2.5, thick);
  return colourOf(density * max(1.0 + granulation * grains, 0.2));
}

// Adds the line over the wash, and the substrate.
vec3 finished(vec3 wash, ivec2 p, vec4 substrate) {
  vec3 ink = mix(vec3(1.0), vec3(0.22, 0.2, 0.22), lineAt(p, 0.5 - substrate.r));
  return onSubstrate(wash * ink, substrate);
}
