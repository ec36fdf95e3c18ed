// Purpose: washes on paper, a pixel at a time: a light wash, a dark one glazed over it where the picture
//          is dark, lines (thesis §3.2.2) and the sheet (§3.5).
// Inputs:  tiling, means (linear), guide (guide.frag), darkPigment and lightPigment (pigment.frag), all
//          three LINEAR; sheet.glsl's; pictureSize, threshold, and the parameters of the same names
//          (watercolor_parameters.h).
// Outputs: sRGB-coded colours.
// Precision: highp for places; colours would do with less.
#include "pipeline/gpu/shaders/colour.glsl"
#include "pipeline/styles/watercolor/shaders/palette.glsl"
#include "pipeline/styles/watercolor/shaders/sheet.glsl"
#include "pipeline/styles/watercolor/shaders/tiling_word.glsl"
uniform highp usampler2D tiling;
uniform sampler2D means;
uniform sampler2D guide;
uniform sampler2D darkPigment;
uniform sampler2D lightPigment;
uniform vec2 pictureSize;
uniform float threshold;
uniform float edgeSoftness;
uniform float edgeDarkness;
uniform float hardness;
uniform float wobble;
uniform float rim;
uniform float gaps;
uniform float granulation;
uniform float variation;
uniform float grain;
uniform float vividness;
uniform float luminosity;
uniform float mosaic;
const vec3 kLuma = vec3(0.299, 0.587, 0.114);

// The sheet's relief, and its warm white.
vec3 onSheet(vec3 colour, vec4 sheet) {
  return colour * (1.0 + grain * (sheet.g - 0.5)) * mix(vec3(1.0), vec3(1.0, 0.992, 0.97), grain);
}

// Optical density: what the pigments of layers add up in (Beer and Lambert: they absorb and do not
// scatter, which is Kubelka and Munk's model of transparent paint over white).
vec3 densityOf(vec3 colour) { return -log2(max(colour, vec3(0.004))); }

// How dark the line is, from 0 to 1.
float lineAt(ivec2 p, float valley) {
  // Four pixels in one read; the mean takes the steps out of the line.
  uvec4 words = textureGather(tiling, (vec2(p) + 1.0) / pictureSize);
  vec4 roots = vec4(words >> 24u) * (1.0 / 255.0);
  float strength = 0.25 * dot(roots, roots);
  float line = smoothstep(threshold * (1.0 - edgeSoftness), threshold * (1.0 + 2.0 * edgeSoftness),
                          strength);
  return clamp(edgeDarkness * line * (0.8 + 0.8 * valley), 0.0, 1.0);
}

// The painted colour of pixel p.
vec3 paintedAt(ivec2 p) {
  vec4 sheet = sheetAt(onPaper(vec2(p) + 0.5), 1.0);
  float valley = 0.5 - sheet.r;
  vec2 at = (vec2(p) + 0.5 + wobble * (sheet.ba - 0.5)) / pictureSize;
  vec3 seen = texture(guide, at).rgb;
  vec4 dark = texture(darkPigment, at);
  vec4 light = texture(lightPigment, at);

  // How much of the dark glaze lies here: a hard border where the picture changes at once from one
  // of the two to the other, a soft one where it does so slowly, and none where they are alike.
  vec3 apart = light.rgb - dark.rgb;
  float contrast = length(apart);
  vec3 axis = apart / max(contrast * contrast, 1.0e-4);
  float where = clamp(dot(seen - dark.rgb, axis), -0.5, 1.5);
  float slope = length(vec2(dot(dFdx(seen), axis), dot(dFdy(seen), axis)));
  float striking = contrast / (0.3 + 0.8 * dot(light.rgb, kLuma));  // the eye sees ratios
  float hard = hardness * smoothstep(0.06, 0.25, striking) * smoothstep(0.02, 0.08, slope);
  float sharp = smoothstep(0.34, 0.66, where + 0.25 * hard * valley);
  float isLight = mix(clamp(where, 0.0, 1.0), sharp, hard);
  float glaze = 1.0 - mix(dark.a, isLight, smoothstep(0.02, 0.08, striking));

  // A third colour, which is neither of the two nor between them.
  vec3 other = seen - dark.rgb - clamp(where, 0.0, 1.0) * apart;
  other *= smoothstep(0.03, 0.12, length(other));

  // Pigment: the load of the brush, the rim where the glaze has dried, what settles in the valleys.
  vec3 lightDensity = densityOf(light.rgb + other);
  vec3 glazeDensity = densityOf(dark.rgb + other) - lightDensity;
  float atRim = hard * smoothstep(0.05, 0.42, where) * (1.0 - isLight);
  vec3 density = lightDensity + glazeDensity * glaze * (1.0 + rim * atRim);
  float more = variation * (light.a - 0.5) * 1.6 + granulation * valley * 2.0;
  // Thick paint is even: the eye sees differences of thin layers.
  float thick = dot(density, kLuma);
  density *= max(1.0 + more / (1.0 + 0.7 * thick), 0.2);
  // A loaded brush skips the highest grains.
  density *= 1.0 - 0.5 * granulation * smoothstep(0.55, 0.9, sheet.r) * smoothstep(1.0, 2.5, thick);
  // Where an emptied brush stopped short of a wet border the paper is left.
  float besideGlaze = hard * smoothstep(0.25, 0.6, contrast) * isLight * (1.0 - smoothstep(0.75, 1.05, where));
  float empty = 0.75 - light.a - 0.15 * valley;
  density *= 1.0 - besideGlaze * smoothstep(0.5 - 0.5 * gaps, 0.6 - 0.5 * gaps, empty);
  vec3 wash = exp2(-density);

  if (mosaic > 0.0) {
    ivec2 cell = cellOf(texelFetch(tiling, p, 0).r);
    wash = mix(wash, painted(srgbFromLinear(texelFetch(means, cell, 0).rgb), vividness, luminosity), mosaic);
  }
  if (edgeDarkness > 0.0) wash *= mix(vec3(1.0), vec3(0.22, 0.2, 0.22), lineAt(p, valley));
  return onSheet(wash, sheet);
}
