// Purpose: the style's inner pictures, for people.
// Inputs:  tiling, means, shifts, darkPigment, lightPigment, paper, picture; `view` as in watercolor.cpp; cellPixels,
//          seed.
// Outputs: RGBA8, sRGB-coded, opaque. Precision: highp.
#include "pipeline/gpu/shaders/colour.glsl"
#include "pipeline/styles/watercolor/shaders/home.glsl"
#include "pipeline/styles/watercolor/shaders/tiling_word.glsl"
uniform highp usampler2D tiling;
uniform sampler2D means;
uniform sampler2D shifts;
uniform sampler2D darkPigment;
uniform sampler2D lightPigment;
uniform sampler2D paper;
uniform sampler2D picture;
uniform int view;
uniform vec2 cellPixels;
uniform vec2 pictureSize;
uniform uint seed;
layout(location = 0) out vec4 colour;

const int kSeeds = 0;
const int kCells = 1;
const int kMeans = 2;
const int kEdges = 3;
const int kRetiling = 4;
const int kDark = 5;
const int kLight = 6;
const int kPaper = 7;

float distanceToLine(vec2 at, vec2 a, vec2 b) {
  vec2 along = b - a;
  float t = clamp(dot(at - a, along) / max(dot(along, along), 1.0e-6), 0.0, 1.0);
  return distance(at, a + t * along);
}

vec3 cellColour(ivec2 cell) {
  uint hash = hashOf(cell, 17u);
  return 0.25 + 0.75 * vec3(uvec3(hash, hash >> 8u, hash >> 16u) & 255u) / 255.0;
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  uint word = texelFetch(tiling, p, 0).r;
  ivec2 cell = cellOf(word);
  vec2 home = homeOf(cell, cellPixels, seed);
  vec2 at = home + texelFetch(shifts, cell, 0).xy;
  float inDot = step(distance(gl_FragCoord.xy, at), 1.2);
  vec3 rgb = vec3(0.0);
  if (view == kSeeds) {
    rgb = mix(0.4 + 0.6 * texelFetch(picture, p, 0).rgb, vec3(0.0), inDot);
  } else if (view == kCells) {
    rgb = mix(cellColour(cell), vec3(0.0), inDot);
  } else if (view == kMeans) {
    rgb = srgbFromLinear(texelFetch(means, cell, 0).rgb);
  } else if (view == kEdges) {
    rgb = isEdge(word) ? vec3(0.0) : vec3(1.0 - 0.7 * sqrt(strengthOf(word)));
  } else if (view == kRetiling) {
    rgb = isEdge(word) ? vec3(0.55) : vec3(1.0);
    float line = step(distanceToLine(gl_FragCoord.xy, home, at), 0.6);
    rgb = mix(rgb, vec3(0.2, 0.4, 0.9), line);
    rgb = mix(rgb, vec3(0.9, 0.1, 0.1), inDot);
  } else if (view == kDark) {
    rgb = texture(darkPigment, gl_FragCoord.xy / pictureSize).rgb;
  } else if (view == kLight) {
    rgb = texture(lightPigment, gl_FragCoord.xy / pictureSize).rgb;
  } else {
    rgb = texelFetch(paper, p & 511, 0).rgb;
    rgb = vec3(rgb.r * 0.5 + rgb.g * 0.5);
  }
  colour = vec4(rgb, 1.0);
}
