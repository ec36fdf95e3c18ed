// Purpose: debug views of the tensor field: short lines along the direction of strokes (thesis
//          figures 15, 16), blue on edges and red where interpolated; the pyramid's levels; or the
//          regions, by their detail; or the focus, darker where strokes are broad.
// Inputs:  picture; field0 to field3: four levels (marks::TensorField::resolved); size and
//          pixelsOfFull: of the frame; view: VIEW_TENSORS, VIEW_PYRAMID, VIEW_REGIONS or VIEW_FOCUS;
//          bands: the detail at which middling and fine strokes begin; focus.glsl's.
// Outputs: RGBA8, sRGB-coded, opaque. Precision: highp for places.
#include "pipeline/marks/shaders/focus.glsl"
uniform sampler2D picture;
uniform highp sampler2D field0;
uniform highp sampler2D field1;
uniform highp sampler2D field2;
uniform highp sampler2D field3;
uniform vec2 size;
uniform int view;
uniform vec2 pixelsOfFull;
uniform vec2 bands;
layout(location = 0) out vec4 colour;

vec4 levelAt(int level, ivec2 region) {
  if (level == 0) return texelFetch(field0, min(region, textureSize(field0, 0) - 1), 0);
  if (level == 1) return texelFetch(field1, min(region, textureSize(field1, 0) - 1), 0);
  if (level == 2) return texelFetch(field2, min(region, textureSize(field2, 0) - 1), 0);
  return texelFetch(field3, min(region, textureSize(field3, 0) - 1), 0);
}

vec3 linesOver(vec3 ground, vec2 px, int level) {
  float side = 8.0 * exp2(float(level)) * 1.5;
  vec2 cell = floor(px / side);
  vec2 middle = (cell + 0.5) * side;
  vec4 tensor = levelAt(level, ivec2(middle / (8.0 * exp2(float(level)))));
  float angle = 0.5 * atan(tensor.y, tensor.x) + 1.5707963;
  vec2 along = vec2(cos(angle), sin(angle));
  vec2 arm = px - middle;
  float t = clamp(dot(arm, along), -0.42 * side, 0.42 * side);
  float away = distance(arm, t * along);
  vec3 line = mix(vec3(0.9, 0.15, 0.1), vec3(0.1, 0.25, 0.95), tensor.z);
  return mix(ground, line, 1.0 - smoothstep(0.6, 1.3, away));
}

void main() {
  vec2 px = gl_FragCoord.xy / pixelsOfFull;
  if (view == VIEW_PYRAMID) {  // one level per quarter
    vec2 half_ = 0.5 * size;
    ivec2 quarter = ivec2(greaterThanEqual(gl_FragCoord.xy, half_));
    vec2 inside = (gl_FragCoord.xy - vec2(quarter) * half_) * 2.0;
    vec3 ground = 0.5 + 0.5 * texture(picture, inside / size).rgb;
    colour = vec4(linesOver(ground, inside / pixelsOfFull, quarter.x + 2 * quarter.y), 1.0);
    return;
  }
  vec3 seen = texture(picture, gl_FragCoord.xy / size).rgb;
  if (view == VIEW_REGIONS) {
    float detail = texture(field1, px * pixelsOfFull / size).w;
    vec3 region = detail > bands.y ? vec3(0.9, 0.3, 0.2)
                  : detail > bands.x ? vec3(0.95, 0.8, 0.3) : vec3(0.3, 0.45, 0.8);
    colour = vec4(mix(region, seen, 0.35), 1.0);
    return;
  }
  if (view == VIEW_FOCUS) {
    colour = vec4(seen * mix(0.25, 1.0, finenessAt(px)), 1.0);
    return;
  }
  colour = vec4(linesOver(0.5 + 0.5 * seen, px, 0), 1.0);
}
