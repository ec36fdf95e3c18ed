// Purpose: puts every point into its bin's list, and counts them.
// Inputs:  points, one per slot (point_bins.glsl); slots: how many.
// Outputs: links: for each bin the count of its points and the slot of one of them; then for each
//          slot the next one. Stored as slot + 1; 0 is none. The order of the lists is random;
//          point_bins_gather.comp sorts them.
// Precision: integers are exact.
#include "pipeline/marks/anchors/shaders/point_bins.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Points { ivec4 points[]; };
layout(std430, binding = 1) buffer Links { uint links[]; };
uniform int slots;

void main() {
  int slot = int(gl_GlobalInvocationID.x);
  if (slot >= slots) return;
  ivec4 point = points[slot];
  if (point.w < 0) return;
  ivec2 bin = binOf(pointPlace(point));
  int index = bin.y * bins.x + bin.x;
  atomicAdd(links[2 * index], 1u);
  links[2 * bins.x * bins.y + slot] = atomicExchange(links[2 * index + 1], uint(slot + 1));
}
