// Purpose: lists blocks in the order of their places, whatever the order of invocations
//          (docs/gpu.md, rule 7). Each invocation of a single group has a stretch of them.
// Inputs:  busy_blocks.glsl's flags, one of which tells what is listed.
// Outputs: functions. Precision: integers.
#include "pipeline/marks/movers/shaders/busy_blocks.glsl"
const int kLanes = 128;
layout(local_size_x = 128) in;
shared uint listedOf[kLanes];  // by an invocation

// Writes the blocks that have a flag to the list that begins at a word, and returns how many there
// are. All invocations call it.
uint list(uint flag, int at) {
  int lane = int(gl_LocalInvocationID.x);
  int each = (blockCount() + kLanes - 1) / kLanes;
  int first = min(lane * each, blockCount());
  int end = min(first + each, blockCount());
  uint own = 0u;
  for (int i = first; i < end; ++i) own += (busyWords[kBusyWords + i] & flag) != 0u ? 1u : 0u;
  listedOf[lane] = own;
  barrier();
  uint before = 0u;
  uint count = 0u;
  for (int i = 0; i < kLanes; ++i) {
    if (i == lane) before = count;
    count += listedOf[i];
  }
  for (int i = first; i < (own == 0u ? first : end); ++i) {
    if ((busyWords[kBusyWords + i] & flag) == 0u) continue;
    busyWords[at + int(before)] = uint(i);
    ++before;
  }
  return count;
}
