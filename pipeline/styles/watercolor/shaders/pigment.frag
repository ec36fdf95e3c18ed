// Purpose: the palette of a place: the two colours, a dark and a light one, that represent its
//          surroundings best, and the load of the brush. Cells have no borders here: each counts by
//          its area nearby. One pixel per 4x4 of the image.
// Inputs:  tiling, darkWash and lightWash (washes.comp), substrate.glsl's, cellPixels, reach
//          (cells); Taps: places of a disc, in its radii, and their weights, the middle first;
//          tapCount: how many (a uniform, so that no compiler unrolls the rounds over them and
//          holds all colours).
// Outputs: darkPigment, lightPigment (RGBA8): sRGB-coded; A of the dark one: the light one's share;
//          A of the light one: the load, 0.5 is normal.
// Precision: highp.
#include "pipeline/gpu/images/shaders/luma.glsl"
#include "pipeline/styles/substrate/shaders/substrate.glsl"
#include "pipeline/styles/watercolor/shaders/tiling_word.glsl"
uniform highp usampler2D tiling;
uniform sampler2D darkWash;
uniform sampler2D lightWash;
uniform vec2 cellPixels;
uniform float reach;
layout(location = 0) out vec4 darkPigment;
layout(location = 1) out vec4 lightPigment;

layout(std140, binding = 0) uniform Taps { vec4 taps[13]; };
uniform int tapCount;

// The amount of pigment in the brush here; 0.5 is normal.
float loadAt(vec2 pixel) {
  vec2 place = onPaper(pixel);
  return 0.5 + 0.7 * (sheetAt(place, 0.25).b - 0.5) + 0.5 * (sheetAt(place, 0.5).a - 0.5);
}

// The two colours of the cell at a tap, weighted by alpha.
void readTap(int tap, out vec4 dark, out vec4 light) {
  ivec2 last = textureSize(tiling, 0) - 1;
  vec2 middle = gl_FragCoord.xy * 4.0;
  ivec2 p = clamp(ivec2(middle + taps[tap].xy * cellPixels * reach), ivec2(0), last);
  ivec2 cell = texelOf(slotOf(texelFetch(tiling, p, 0).r));
  float weight = taps[tap].z;
  light = texelFetch(lightWash, cell, 0);
  dark = vec4(texelFetch(darkWash, cell, 0).rgb, weight * (1.0 - light.a));
  light.a *= weight;
}

// Sums over colours c, weighted, of c, of the products of two of its components and of three.
struct Moments {
  float weight;
  vec3 first;
  vec3 squares;  // rr, gg, bb
  vec3 mixed;    // gb, br, rg
  vec3 cubes;    // rrr, ggg, bbb
  vec3 next;     // rrg, ggb, bbr
  vec3 previous; // rrb, ggr, bbg
  float all;     // rgb
};

void add(inout Moments m, vec3 c, float weight) {
  vec3 w = weight * c;
  vec3 squares = w * c;
  vec3 mixed = w.gbr * c.brg;
  m.weight += weight;
  m.first += w;
  m.squares += squares;
  m.mixed += mixed;
  m.cubes += squares * c;
  m.next += squares * c.gbr;
  m.previous += squares * c.brg;
  m.all += mixed.r * c.r;
}

// The sum of c (c . axis).
vec3 alongOf(Moments m, vec3 axis) {
  return m.squares * axis + m.mixed.brg * axis.gbr + m.mixed.gbr * axis.brg;
}

// The sum of (c . axis)^3.
float cubeOf(Moments m, vec3 axis) {
  vec3 squared = axis * axis;
  return dot(m.cubes, squared * axis) + 3.0 * dot(m.next, squared * axis.gbr) +
         3.0 * dot(m.previous, squared * axis.brg) + 6.0 * m.all * axis.r * axis.g * axis.b;
}

// How the surroundings' colours are spread along the axis on which they differ most.
struct Spread {
  vec3 mean;
  vec3 axis;
  float deviation;
  float skew;
};

// One round over the taps adds up moments; colours count from the middle's, so that the small
// differences of a plain place are exact.
Spread spreadOf() {
  vec4 dark;
  vec4 light;
  readTap(0, dark, light);
  vec3 origin = light.rgb;
  Moments m = Moments(0.0, vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), 0.0);
  for (int i = 0; i < tapCount; ++i) {
    readTap(i, dark, light);
    add(m, dark.rgb - origin, dark.a);
    add(m, light.rgb - origin, light.a);
  }
  vec3 mean = m.first / m.weight;
  // Power iteration that starts at luma's axis.
  vec3 axis = vec3(0.5, 0.7, 0.4);
  for (int round = 0; round < 2; ++round) {
    axis = normalize(1.0e-5 + alongOf(m, axis) - m.first * dot(mean, axis));
  }
  float middle = dot(mean, axis);
  float square = dot(alongOf(m, axis), axis);
  float variance = max(square / m.weight - middle * middle, 1.0e-6);
  float third = cubeOf(m, axis) / m.weight - 3.0 * middle * square / m.weight +
                2.0 * middle * middle * middle;
  float deviation = sqrt(variance);
  return Spread(origin + mean, axis, deviation,
                clamp(third / (variance * deviation), -3.0, 3.0));
}

void main() {
  Spread s = spreadOf();
  float up = 0.5 * (s.skew + sqrt(s.skew * s.skew + 4.0));
  float share = 1.0 / (1.0 + up * up);
  // The two colours: the means of the colours on either side.
  vec4 low = vec4(s.mean, 1.0) * 1.0e-4;
  vec4 high = low;
  float border = 0.5 * (up - 1.0 / up) * s.deviation;
  float steep = 4.0 / s.deviation;
  for (int i = 0; i < tapCount; ++i) {
    vec4 dark;
    vec4 light;
    readTap(i, dark, light);
    float a = dot(dark.rgb - s.mean, s.axis) - border;
    float b = dot(light.rgb - s.mean, s.axis) - border;
    vec4 d = vec4(dark.rgb, 1.0) * dark.a;
    vec4 l = vec4(light.rgb, 1.0) * light.a;
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
  lightPigment = vec4(swapped ? one : other, loadAt(gl_FragCoord.xy * 4.0));
}
