// Purpose: rewrites the filtered frame on virtual objects, whose own motion leads to their past. A
//          separate pass after filtered_frame.comp, because there are few such pixels.
// Inputs:  filtered_frame.glsl's; ids, and motion (ArFrame) if hasMotion.
// Outputs: filtered, on virtual objects. One invocation per block of 4x4 pixels, since software
//          renderers pay for each.
// Precision: highp.
#include "pipeline/gpu/images/shaders/pixel_block.glsl"
#include "pipeline/scene/render/shaders/object_id.glsl"
#include "pipeline/marks/shaders/filtered_frame.glsl"
layout(local_size_x = 16, local_size_y = 4) in;
uniform sampler2D motion;
uniform highp usampler2D ids;
uniform bool hasMotion;

void average(ivec2 p, uint object) {
  ivec2 size = textureSize(picture, 0);
  vec4 moved = hasMotion ? texelFetch(motion, p, 0) : vec4(0.0);
  bool isKnown = moved.w > 0.5;
  vec2 at = vec2(p) + 0.5 - (isKnown ? moved.xy : vec2(0.0));
  vec4 there = textureLod(past, at / vec2(size), 0.0);
  float frames = isVirtual(object) ? -there.a : there.a;
  float trust = isKnown && isInside(at, size) ? trustOf(moved.z) * max(frames, 0.0) : 0.0;
  vec3 sum = vec3(0.0);
  vec3 squares = vec3(0.0);
  for (int i = 0; i < 9; ++i) {
    vec3 colour = texelFetch(picture, clamp(p + ivec2(i % 3, i / 3) - 1, ivec2(0), size - 1), 0).rgb;
    sum += colour;
    squares += colour * colour;
  }
  vec4 averages = averaged(texelFetch(picture, p, 0).rgb, there.rgb, trust, sum, squares);
  imageStore(filtered, p, isVirtual(object) ? vec4(averages.rgb, -averages.a) : averages);
}

bool showsObjects(ivec2 corner, ivec2 last) {
  uint all = 0u;
  for (int i = 0; i < kBlockPixels; ++i) all |= texelFetch(ids, min(corner + inBlock(i), last), 0).r;
  return objectOf(all) != 0u;
}

void main() {
  ivec2 corner = ivec2(gl_GlobalInvocationID.xy) * kBlockSide;
  ivec2 last = textureSize(picture, 0) - 1;
  if (any(greaterThan(corner, last))) return;
  // A loop in place of `if`: software renderers run both sides of a branch, but skip a loop that no
  // invocation enters.
  for (int i = showsObjects(corner, last) ? 0 : kBlockPixels; i < kBlockPixels; ++i) {
    ivec2 p = corner + inBlock(i);
    uint object = objectOf(texelFetch(ids, min(p, last), 0).r);
    if (object != 0u) average(p, object);  // beyond the border: no effect
  }
}
