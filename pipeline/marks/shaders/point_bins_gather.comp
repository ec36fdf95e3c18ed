// Purpose: lays each bin's points in their place, slots upwards, so that nothing is left of the order in
//          which they came.
// Inputs:  points; links (point_bins_link.comp; lists are emptied here for the next frame), starts
//          (point_bins_scan.comp), count: of bins.
// Outputs: sorted.
// Precision: integers are exact.
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Points { ivec4 points[]; };
layout(std430, binding = 1) buffer Links { uint links[]; };
layout(std430, binding = 2) readonly buffer Starts { uint starts[]; };
layout(std430, binding = 3) buffer Sorted { ivec4 sorted[]; };
uniform int count;

void main() {
  int bin = int(gl_GlobalInvocationID.x);
  if (bin >= count) return;
  uint first = starts[bin];
  uint next = links[2 * bin + 1];
  links[2 * bin + 1] = 0u;
  for (uint end = first; next != 0u; ++end) {
    ivec4 point = points[next - 1u];
    next = links[2u * uint(count) + next - 1u];
    uint place = end;
    while (place > first && sorted[place - 1u].w > point.w) {
      sorted[place] = sorted[place - 1u];
      --place;
    }
    sorted[place] = point;
  }
}
