// Purpose: the colour that each cell is painted with: by itself, and run together with its
//          neighbours of like colour. One pixel a cell.
// Inputs:  means (linear), shifts, seed; `vividness`, `luminosity`, `variation` in [0, 1].
// Outputs: flatWash (RG32UI, cell_paint.glsl), softWash (RGBA8); both sRGB-coded.
// Precision: highp; means of like cells are taken in linear light.
#include "pipeline/gpu/shaders/colour.glsl"
#include "pipeline/styles/watercolor/shaders/cell_paint.glsl"
#include "pipeline/styles/watercolor/shaders/hash.glsl"
uniform sampler2D means;
uniform sampler2D shifts;
uniform uint seed;
uniform float vividness;
uniform float luminosity;
uniform float variation;
layout(location = 0) out uvec2 flatWash;
layout(location = 1) out vec4 softWash;

const vec3 kDarkest = vec3(0.10, 0.11, 0.15);  // no pigment is black: an indigo

// Transparent paint on white: lights open up towards the paper, darks stay coloured.
vec3 painted(vec3 linearRgb) {
  vec3 srgb = srgbFromLinear(clamp(linearRgb, 0.0, 1.0));
  float luma = dot(srgb, vec3(0.299, 0.587, 0.114));
  vec3 vivid = clamp(luma + (srgb - luma) * (1.0 + vividness), 0.0, 1.0);
  vec3 open = 1.0 - (1.0 - vivid) * (1.0 - luminosity * vivid);
  return mix(open, kDarkest + (1.0 - kDarkest) * open, luminosity);
}

// How much pigment a load of the brush has; 0.5 is the usual amount.
float loadAt(ivec2 cell, int spacing, uint salt) {
  vec2 scaled = (vec2(cell) + 0.5) / float(spacing);
  ivec2 base = ivec2(floor(scaled));
  vec2 w = smoothstep(0.0, 1.0, scaled - vec2(base));
  float a = unitOf(hashOf(base, salt));
  float b = unitOf(hashOf(base + ivec2(1, 0), salt));
  float c = unitOf(hashOf(base + ivec2(0, 1), salt));
  float d = unitOf(hashOf(base + ivec2(1, 1), salt));
  return mix(mix(a, b, w.x), mix(c, d, w.x), w.y);
}

void main() {
  ivec2 cell = ivec2(gl_FragCoord.xy);
  ivec2 last = textureSize(means, 0) - 1;
  vec3 own = texelFetch(means, cell, 0).rgb;
  vec3 ownRoot = sqrt(own);  // near enough to how the eye judges likeness
  vec3 sum = vec3(0.0);
  float weights = 0.0;
  for (int y = -2; y <= 2; ++y) {
    for (int x = -2; x <= 2; ++x) {
      vec3 other = texelFetch(means, clamp(cell + ivec2(x, y), ivec2(0), last), 0).rgb;
      vec3 apart = sqrt(other) - ownRoot;
      float weight = exp(-0.35 * float(x * x + y * y) - 60.0 * dot(apart, apart));
      sum += weight * other;
      weights += weight;
    }
  }
  float load = 0.5 * loadAt(cell, 7, seed + 1u) + 0.3 * loadAt(cell, 3, seed + 2u) +
               0.2 * unitOf(hashOf(cell, seed + 3u));
  float more = variation * (load - 0.5) * 1.6;
  vec2 shift = texelFetch(shifts, cell, 0).xy;
  flatWash = packPaint(withPigment(painted(own), more), shift);
  softWash = vec4(withPigment(painted(sum / weights), more), 1.0);
}
