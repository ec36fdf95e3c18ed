// Purpose: the start of each bin's points: a prefix sum of the counts. A single work group.
// Inputs:  links (point_bins_link.comp; counts are cleared here for the next frame), count: of
//          bins.
// Outputs: starts: count + 1 places.
// Precision: integers are exact.
layout(local_size_x = 128) in;
layout(std430, binding = 0) buffer Links { uint links[]; };
layout(std430, binding = 1) writeonly buffer Starts { uint starts[]; };
uniform int count;
shared uint sums[128];

void main() {
  int share = (count + 127) / 128;
  int first = int(gl_LocalInvocationID.x) * share;
  int end = min(first + share, count);
  uint sum = 0u;
  for (int i = first; i < end; ++i) sum += links[2 * i];
  sums[gl_LocalInvocationID.x] = sum;
  barrier();
  uint before = 0u;
  for (int i = 0; i < int(gl_LocalInvocationID.x); ++i) before += sums[i];
  for (int i = first; i < end; ++i) {
    starts[i] = before;
    before += links[2 * i];
    links[2 * i] = 0u;
  }
  if (gl_LocalInvocationID.x == 127u) starts[count] = before;
}
