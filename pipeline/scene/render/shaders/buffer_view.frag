// Purpose: pictures of an AR frame's buffers, for people to look at.
// Inputs:  the buffers (scene/render/ar_frame.h; a single texel for a missing one); view, as
//          scene::bufferViews() numbers them; depthRange: the near and the far plane in metres.
// Outputs: colour RGBA8, sRGB-coded.
// Precision: highp for ids and depth.
#include "pipeline/scene/render/shaders/object_id.glsl"
#include "pipeline/scene/render/shaders/surface_form.glsl"

uniform int view;
uniform vec2 depthRange;
uniform highp usampler2D ids;
uniform highp sampler2D depth;
uniform sampler2D normalFocus;
uniform highp usampler2D parts;
uniform highp usampler2D forms;
uniform highp usampler2D barycentrics;
uniform highp sampler2D motion;

layout(location = 0) out vec4 colour;

const float kFullMotionPx = 16.0;

// One hue per number; neighbours are far apart (Weyl sequence of the golden ratio).
vec3 hue(float turns) {
  return clamp(abs(fract(turns + vec3(0.0, 2.0, 1.0) / 3.0) * 6.0 - 3.0) - 1.0, 0.0, 1.0);
}

vec3 colourOf(uint number) {
  float turns = fract(float(number % 4096u) * 0.61803399);
  float light = 0.55 + 0.45 * fract(float(number % 4096u) * 0.75487767);
  return light * mix(vec3(1.0), hue(turns), 0.75);
}

// White is nearest; models in front of the camera are never black.
float nearness(float window) {
  float near = depthRange.x;
  float far = depthRange.y;
  float metres = 2.0 * far * near / (far + near - (2.0 * window - 1.0) * (far - near));
  return 1.0 - 0.85 * (metres - near) / (far - near);
}

vec3 motionColour(vec4 moved) {
  if (moved.w == 0.0) return vec3(0.0);
  float strength = sqrt(min(length(moved.xy) / kFullMotionPx, 1.0));
  float turns = atan(moved.y, moved.x) / 6.28318531;
  return mix(vec3(0.5), hue(turns), strength);
}

vec3 errorColour(vec4 moved) {
  if (moved.w == 0.0) return vec3(0.0);
  float e = clamp(moved.z, 0.0, 1.0);
  return vec3(1.0, 1.0 - smoothstep(0.25, 1.0, e), 1.0 - min(e / 0.25, 1.0));
}

vec3 directionColour(uint form) {
  vec2 across = tensorOf(form);
  return mix(vec3(0.5), hue(atan(-across.y, -across.x) / 6.28318531), length(across));
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  ivec2 surface = min(pixel, textureSize(ids, 0) - 1);
  uint id = texelFetch(ids, surface, 0).r;
  uint part = texelFetch(parts, min(pixel, textureSize(parts, 0) - 1), 0).r;
  uint corners = texelFetch(barycentrics, min(pixel, textureSize(barycentrics, 0) - 1), 0).r;
  uint form = texelFetch(forms, min(pixel, textureSize(forms, 0) - 1), 0).r;
  vec4 moved = texelFetch(motion, min(pixel, textureSize(motion, 0) - 1), 0);
  vec4 facing = texelFetch(normalFocus, surface, 0);
  vec2 at = unpackUnorm2x16(corners);
  vec3 c = vec3(0.0);
  bool isObject = objectOf(id) != 0u;
  if (view == 0 && isObject) c = vec3(nearness(texelFetch(depth, surface, 0).r));
  if (view == 1 && isObject) c = colourOf(objectOf(id));
  if (view == 2 && isObject) c = colourOf(numberOf(part) + 7u * objectOf(part));
  if (view == 3 && isObject) c = colourOf(numberOf(id) + 7u * objectOf(id));
  if (view == 4 && isObject) c = vec3(at, 1.0 - at.x - at.y);
  if (view == 5 && isObject) c = facing.rgb;
  if (view == 6) c = facing.aaa;
  if (view == 7) c = motionColour(moved);
  if (view == 8) c = errorColour(moved);
  if (view == 9 && isObject) c = colourOf(labelOf(form));
  if (view == 10 && isObject) c = directionColour(form);
  colour = vec4(c, 1.0);
}
