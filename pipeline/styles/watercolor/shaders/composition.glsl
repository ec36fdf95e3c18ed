// Purpose: washes on paper, edges drawn dark over them (thesis §3.2.2, §3.5), a pixel at a time.
// Inputs:  tiling, flatWash and softWash (wash.frag; the soft one LINEAR), paper;
//          pictureSize, threshold, and the parameters of the same names (watercolor_parameters.h).
// Outputs: sRGB-coded colours.
// Precision: highp for places; colours would do with less.
#include "pipeline/styles/watercolor/shaders/cell_paint.glsl"
#include "pipeline/styles/watercolor/shaders/tiling_word.glsl"
uniform highp usampler2D tiling;
uniform highp usampler2D flatWash;
uniform sampler2D softWash;
uniform sampler2D paper;
uniform vec2 pictureSize;
uniform float threshold;
uniform float edgeSoftness;
uniform float edgeDarkness;
uniform float bleeding;
uniform float wobble;
uniform float rim;
uniform float granulation;
uniform float grain;
const vec3 kLuma = vec3(0.299, 0.587, 0.114);

// The sheet's relief, and its warm white.
vec3 onSheet(vec3 colour, vec4 sheet) {
  return colour * (1.0 + grain * (sheet.g - 0.5)) * mix(vec3(1.0), vec3(1.0, 0.992, 0.97), grain);
}

// The painted colour of pixel p.
vec3 paintedAt(ivec2 p) {
  ivec2 last = textureSize(tiling, 0) - 1;
  vec4 sheet = texelFetch(paper, p & 511, 0);
  // Brush and water do not follow the straight sides of cells.
  ivec2 q = clamp(p + ivec2(floor(wobble * (sheet.ba * 2.0 - 1.0) + 0.5)), ivec2(0), last);
  uint word = texelFetch(tiling, q, 0).r;
  ivec2 cell = cellOf(word);
  uvec2 paint = texelFetch(flatWash, cell, 0).rg;
  vec3 own = colourOf(paint);
  vec3 soft = texture(softWash, (vec2(q) + 0.5) / pictureSize).rgb;
  vec3 apart = soft - own;
  float alike = 1.0 / (1.0 + 8.0 * dot(apart, apart));
  vec3 wash = mix(own, soft, bleeding * alike);
  float luma = dot(wash, kLuma);

  // The grain that pigment settles in travels with its cell; the relief stays with the sheet.
  ivec2 shift = ivec2(floor(shiftOf(paint) + 0.5));
  float valley = 0.5 - texelFetch(paper, (q - shift) & 511, 0).r;
  float settles = luma * (1.0 - luma) * 4.0;
  float more = granulation * valley * settles * 3.0;
  more += rim * clamp(dot(apart, kLuma) * 3.0, -0.5, 0.5);
  wash = withPigment(wash, clamp(more, -1.0, 1.0));

  // Four pixels in one read; the mean takes the steps out of the line.
  uvec4 words = textureGather(tiling, (vec2(q) + 1.0) / pictureSize);
  vec4 roots = vec4(words >> 24u) * (1.0 / 255.0);
  float strength = 0.25 * dot(roots, roots);
  float line = smoothstep(threshold * (1.0 - edgeSoftness), threshold * (1.0 + 2.0 * edgeSoftness),
                          strength);
  line *= edgeDarkness * (0.75 + granulation * valley);
  wash = withPigment(wash, clamp(line, 0.0, 1.0));
  wash *= 1.0 - 0.35 * clamp(line, 0.0, 1.0);

  return onSheet(wash, sheet);
}
