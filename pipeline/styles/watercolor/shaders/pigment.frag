// Purpose: the palette of a place: the two colours, a dark and a light one, that represent its
//          surroundings best, and the load of the brush. Cells have no borders here: each counts by
//          its area nearby. One pixel per 4x4 of the image.
// Inputs:  tiling, darkWash and lightWash (washes.comp), substrate.glsl's, cellPixels, reach
//          (cells).
// Outputs: darkPigment, lightPigment (RGBA8): sRGB-coded; A of the dark one: the light one's share;
//          A of the light one: the load, 0.5 is normal.
// Precision: highp.
#include "pipeline/gpu/shaders/luma.glsl"
#include "pipeline/styles/substrate/shaders/substrate.glsl"
#include "pipeline/styles/watercolor/shaders/tiling_word.glsl"
uniform highp usampler2D tiling;
uniform sampler2D darkWash;
uniform sampler2D lightWash;
uniform vec2 cellPixels;
uniform float reach;
layout(location = 0) out vec4 darkPigment;
layout(location = 1) out vec4 lightPigment;

// A disc of taps: the middle, six around it, six further out between them.
const int kTaps = 13;
const vec2 kTap[13] = vec2[13](
    vec2(0.0), vec2(0.52, 0.0), vec2(0.26, 0.45), vec2(-0.26, 0.45), vec2(-0.52, 0.0),
    vec2(-0.26, -0.45), vec2(0.26, -0.45), vec2(0.83, 0.48), vec2(0.0, 0.96), vec2(-0.83, 0.48),
    vec2(-0.83, -0.48), vec2(0.0, -0.96), vec2(0.83, -0.48));

// The amount of pigment in the brush here; 0.5 is normal.
float loadAt(vec2 pixel) {
  vec2 place = onPaper(pixel);
  return 0.5 + 0.7 * (sheetAt(place, 0.25).b - 0.5) + 0.5 * (sheetAt(place, 0.5).a - 0.5);
}

void main() {
  ivec2 last = textureSize(tiling, 0) - 1;
  vec2 middle = gl_FragCoord.xy * 4.0;
  vec4 dark[kTaps];
  vec4 light[kTaps];
  vec3 mean = vec3(0.0);
  float weights = 0.0;
  for (int i = 0; i < kTaps; ++i) {
    ivec2 p = clamp(ivec2(middle + kTap[i] * cellPixels * reach), ivec2(0), last);
    ivec2 cell = texelOf(slotOf(texelFetch(tiling, p, 0).r));
    float w = i == 0 ? 1.2 : i < 7 ? 1.0 : 0.55;
    light[i] = texelFetch(lightWash, cell, 0);
    dark[i] = vec4(texelFetch(darkWash, cell, 0).rgb, w * (1.0 - light[i].a));
    light[i].a *= w;
    mean += dark[i].rgb * dark[i].a + light[i].rgb * light[i].a;
    weights += w;
  }
  mean /= weights;

  // The direction in which the colours differ most, by power iteration that starts at luma's.
  vec3 axis = vec3(0.5, 0.7, 0.4);
  for (int round = 0; round < 2; ++round) {
    vec3 next = vec3(1.0e-5);
    for (int i = 0; i < kTaps; ++i) {
      vec3 a = dark[i].rgb - mean;
      vec3 b = light[i].rgb - mean;
      next += dark[i].a * dot(a, axis) * a + light[i].a * dot(b, axis) * b;
    }
    axis = normalize(next);
  }
  float variance = 0.0;
  float third = 0.0;
  for (int i = 0; i < kTaps; ++i) {
    float a = dot(dark[i].rgb - mean, axis);
    float b = dot(light[i].rgb - mean, axis);
    variance += dark[i].a * a * a + light[i].a * b * b;
    third += dark[i].a * a * a * a + light[i].a * b * b * b;
  }
  variance = max(variance / weights, 1.0e-6);
  float spread = sqrt(variance);
  float skew = clamp(third / (weights * variance * spread), -3.0, 3.0);
  float up = 0.5 * (skew + sqrt(skew * skew + 4.0));
  float share = 1.0 / (1.0 + up * up);
  // The two colours: the means of the colours on either side.
  vec4 low = vec4(mean, 1.0) * 1.0e-4;
  vec4 high = low;
  float border = 0.5 * (up - 1.0 / up) * spread;
  for (int i = 0; i < kTaps; ++i) {
    float a = dot(dark[i].rgb - mean, axis) - border;
    float b = dot(light[i].rgb - mean, axis) - border;
    vec4 d = vec4(dark[i].rgb, 1.0) * dark[i].a;
    vec4 l = vec4(light[i].rgb, 1.0) * light[i].a;
    float steep = 4.0 / spread;
    // Bounded, because the result of exp() beyond a float's range depends on the GPU.
    float wd = 1.0 / (1.0 + exp(min(-steep * a, 60.0)));
    float wl = 1.0 / (1.0 + exp(min(-steep * b, 60.0)));
    low += d * (1.0 - wd) + l * (1.0 - wl);
    high += d * wd + l * wl;
  }
  vec3 one = low.rgb / low.a;
  vec3 other = high.rgb / high.a;
  bool swapped = lumaOf(one - other) > 0.0;
  darkPigment = vec4(swapped ? other : one, swapped ? 1.0 - share : share);
  lightPigment = vec4(swapped ? one : other, loadAt(middle));
}
