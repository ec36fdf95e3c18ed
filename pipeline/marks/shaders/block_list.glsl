// Purpose: lists blocks in the order of their places, whatever the order of invocations
//          (docs/gpu.md, rule 7). Each invocation of a single group of 64 has a stretch of them.
// Inputs:  busy_blocks.glsl's flags, one of which tells what is listed.
// Outputs: functions. Precision: integers.
#include "pipeline/marks/shaders/busy_blocks.glsl"
layout(local_size_x = 64) in;
shared uint listedOf[64];  // by an invocation

// The blocks of an invocation: from x to below y.
ivec2 stretch() {
  int each = (blockCount() + 63) / 64;
  int first = min(int(gl_LocalInvocationID.x) * each, blockCount());
  return ivec2(first, min(first + each, blockCount()));
}

// Writes the blocks of the stretch that have a flag, `own` of them, to the list that begins at a word,
// and returns how many there are in all. All invocations call it.
uint list(ivec2 blocks, uint own, uint flag, int at) {
  listedOf[gl_LocalInvocationID.x] = own;
  barrier();
  uint before = 0u;
  uint count = 0u;
  for (int i = 0; i < 64; ++i) {
    if (i == int(gl_LocalInvocationID.x)) before = count;
    count += listedOf[i];
  }
  for (int i = blocks.x; i < blocks.y; ++i) {
    if ((busyWords[kBusyWords + i] & flag) == 0u) continue;
    busyWords[at + int(before)] = uint(i);
    ++before;
  }
  return count;
}
