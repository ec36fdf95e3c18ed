// Purpose: writes each bin's points in rising order of slots, so that the result does not depend on
//          the order of the lists.
// Inputs:  points; links (point_bins_link.comp; lists are cleared here for the next frame), starts
//          (point_bins_scan.comp), slots: how many.
// Outputs: sorted.
// Precision: integers are exact.
#include "pipeline/marks/anchors/shaders/point_bins.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Points { ivec4 points[]; };
layout(std430, binding = 1) buffer Links { uint links[]; };
layout(std430, binding = 2) readonly buffer Starts { uint starts[]; };
// volatile: docs/gpu.md, rule 22
layout(std430, binding = 3) volatile buffer Sorted { ivec4 sorted[]; };
uniform int slots;

const uint kHeap = 48u;  // points in a bin, above which gatherAll() is used

void store(uint place, ivec4 point) {
  sorted[place].xy = point.xy;
  sorted[place].zw = point.zw;
}

void insertAll(uint first, uint next) {
  for (uint end = first; next != 0u; ++end) {
    ivec4 point = points[next - 1u];
    next = links[uint(2 * bins.x * bins.y) + next - 1u];
    uint place = end;
    while (place > first && sorted[place - 1u].w > point.w) {
      store(place, sorted[place - 1u]);
      --place;
    }
    store(place, point);
  }
}

// For very full bins, which would take quadratic time (llvmpipe ends a shader's loops after 65535
// rounds).
void gatherAll(uint first, uint end, ivec2 bin) {
  for (int slot = 0; slot < slots && first < end; ++slot) {
    ivec4 point = points[slot];
    if (point.w >= 0 && binOf(pointPlace(point)) == bin) store(first++, point);
  }
}

void main() {
  int index = int(gl_GlobalInvocationID.x);
  if (index >= bins.x * bins.y) return;
  uint first = starts[index];
  uint end = starts[index + 1];
  uint next = links[2 * index + 1];
  links[2 * index + 1] = 0u;
  if (end - first > kHeap) {
    gatherAll(first, end, ivec2(index % bins.x, index / bins.x));
  } else {
    insertAll(first, next);
  }
}
