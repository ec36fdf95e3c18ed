// Purpose: the style's debug views.
// Inputs:  tiling, means, places and ways (show_seeds.comp), darkPigment, lightPigment, paper, picture;
//          `view`: one of VIEW_…, the style's list of views; pictureSize.
// Outputs: RGBA8, sRGB-coded, opaque. Precision: highp.
#include "pipeline/gpu/shaders/colour.glsl"
#include "pipeline/gpu/shaders/hash.glsl"
#include "pipeline/styles/substrate/shaders/tile.glsl"
#include "pipeline/styles/watercolor/shaders/tiling_word.glsl"
uniform highp usampler2D tiling;
uniform sampler2D means;
uniform sampler2D places;
uniform sampler2D ways;
uniform sampler2D darkPigment;
uniform sampler2D lightPigment;
uniform sampler2D paper;
uniform sampler2D picture;
uniform int view;
uniform vec2 pictureSize;
layout(location = 0) out vec4 colour;

// In the order of marks::MotionSource: unknown, surface, plane, image, features, flow, still.
const vec3 kSourceColours[7] =
    vec3[7](vec3(0.5), vec3(0.9, 0.5, 0.1), vec3(0.75, 0.25, 0.8), vec3(0.2, 0.45, 0.9),
            vec3(0.1, 0.7, 0.65), vec3(0.85, 0.15, 0.2), vec3(0.3, 0.65, 0.2));

float distanceToLine(vec2 at, vec2 a, vec2 b) {
  vec2 along = b - a;
  float t = clamp(dot(at - a, along) / max(dot(along, along), 1.0e-6), 0.0, 1.0);
  return distance(at, a + t * along);
}

vec3 cellColour(uint slot) {
  uint hash = hashOf(ivec2(int(slot), 0), 17u);
  return 0.25 + 0.75 * vec3(uvec3(hash, hash >> 8u, hash >> 16u) & 255u) / 255.0;
}

// New anchors are pale; the hue is the source of their motion.
vec3 anchorColour(vec4 way) {
  vec3 hue = kSourceColours[clamp(int(way.x + 0.5), 0, 6)];
  return mix(vec3(1.0), hue, (0.35 + 0.65 * (1.0 - exp(-way.y))) * way.z);
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  uint word = texelFetch(tiling, p, 0).r;
  ivec2 cell = texelOf(slotOf(word));
  vec4 place = texelFetch(places, cell, 0);
  vec4 way = texelFetch(ways, cell, 0);
  vec2 at = place.xy;
  float inDot = step(distance(gl_FragCoord.xy, at), 1.2);
  vec3 rgb = vec3(0.0);
  if (view == VIEW_SEEDS) {
    rgb = mix(0.4 + 0.6 * texelFetch(picture, p, 0).rgb, vec3(0.0), inDot);
  } else if (view == VIEW_ANCHORS) {
    rgb = mix(anchorColour(way), vec3(0.0), step(distance(gl_FragCoord.xy, place.zw), 1.2));
  } else if (view == VIEW_CELLS) {
    rgb = mix(cellColour(slotOf(word)), vec3(0.0), inDot);
  } else if (view == VIEW_MEANS) {
    rgb = srgbFromLinear(texelFetch(means, cell, 0).rgb);
  } else if (view == VIEW_EDGES) {
    rgb = isEdge(word) ? vec3(0.0) : vec3(1.0 - 0.7 * sqrt(strengthOf(word)));
  } else if (view == VIEW_RETILING) {
    rgb = isEdge(word) ? vec3(0.55) : vec3(1.0);
    float line = step(distanceToLine(gl_FragCoord.xy, place.zw, at), 0.6);
    rgb = mix(rgb, vec3(0.2, 0.4, 0.9), line);
    rgb = mix(rgb, way.w > 0.5 ? vec3(0.9, 0.1, 0.1) : vec3(0.0), inDot);
  } else if (view == VIEW_FILTERED) {
    rgb = texelFetch(picture, p, 0).rgb;
  } else if (view == VIEW_DARK) {
    rgb = texture(darkPigment, gl_FragCoord.xy / pictureSize).rgb;
  } else if (view == VIEW_LIGHT) {
    rgb = texture(lightPigment, gl_FragCoord.xy / pictureSize).rgb;
  } else if (view == VIEW_PAPER) {
    rgb = texelFetch(paper, p & (kTile - 1), 0).rgb;
    rgb = vec3(rgb.r * 0.5 + rgb.g * 0.5);
  }
  colour = vec4(rgb, 1.0);
}
