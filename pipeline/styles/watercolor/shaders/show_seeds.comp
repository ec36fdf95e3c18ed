// Purpose: copies seeds and their anchors into textures that the fragment shaders of the debug
//          views can read.
// Inputs:  anchors (marks/anchors/shaders/anchor.glsl), seeds (seed.glsl), points (marks/anchors/shaders/point.glsl): of this
//          frame's tiling; slots, pixelsOfFull.
// Outputs: places (RGBA32F): px of the seed and of its anchor; ways (RGBA16F): the source of the
//          anchor's motion, its age in s, its fade, 1 if its seed is moving.
// Precision: highp.
#include "pipeline/marks/anchors/shaders/anchor.glsl"
#include "pipeline/marks/anchors/shaders/point.glsl"
#include "pipeline/styles/watercolor/shaders/seed.glsl"
#include "pipeline/styles/watercolor/shaders/tiling_word.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Anchors { Anchor anchors[]; };
layout(std430, binding = 1) readonly buffer Seeds { Seed seeds[]; };
layout(std430, binding = 2) readonly buffer Points { ivec4 points[]; };
layout(binding = 0, rgba32f) writeonly uniform highp image2D places;
layout(binding = 1, rgba16f) writeonly uniform highp image2D ways;
uniform int slots;
uniform vec2 pixelsOfFull;

void main() {
  int slot = int(gl_GlobalInvocationID.x);
  if (slot >= slots) return;
  Anchor anchor = anchors[slot];
  vec2 at = pointPlace(points[slot]);
  float moving = (seeds[slot].state & kMoving) != 0u ? 1.0 : 0.0;
  ivec2 texel = texelOf(uint(slot));
  imageStore(places, texel, vec4(at, anchor.px * pixelsOfFull));
  imageStore(ways, texel,
             vec4(float(anchor.state & kSourceBits), ageOf(anchor.ageAndRank), anchor.fade, moving));
}
