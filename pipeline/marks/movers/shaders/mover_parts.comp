// Purpose: the parts of movers that hang together, and their movers' numbers. A part that has no
//          number takes that of one beside it, or else the one that is least near. Of two parts that have the same
//          number, but are clearly apart, the smaller takes another one before they meet; parts of
//          one number that are left in another one take its number. Of more than kMostParts parts, the
//          last ones, row by row, take the first number.
// Inputs:  blocks (mover_parts_count.comp): how many cells of each mover; mover_motion.glsl's: the
//          previous frame's; busy_blocks.glsl's commands.
// Outputs: numbers RGBA8, of 255: R: that of cells that have none; GBA: what the numbers 1 to 3
//          become. One group of invocations for all blocks.
// Precision: highp.
#include "pipeline/marks/movers/shaders/busy_blocks.glsl"
#include "pipeline/marks/movers/shaders/layer_cells.glsl"
#include "pipeline/marks/movers/shaders/mover_motion.glsl"
#include "pipeline/marks/movers/shaders/mover_parts.glsl"
layout(local_size_x = 128) in;
layout(rgba8, binding = 0) writeonly uniform highp image2D numbers;
layout(std430, binding = 0) coherent buffer Blocks { MoverBlock blocks[]; };

const uint kMostParts = 64u;
const int kBeside = 2;     // blocks between: of one mover that has just been found in two parts
const int kClearly = 2;    // blocks between: two movers
const int kSoonMeet = 6;   // blocks
const uint kLarge = 24u;   // sampled cells
const float kLeftOver = 0.15;
const float kLeastAlike = 0.2;  // of a mover's cells, of those of another one that moves alike

shared uint partCount;
shared uint firsts[128];  // first blocks in an invocation's stretch of them
shared uint parts[kMostParts];  // their first blocks
shared uint majors[kMostParts];
shared uint fills[kMostParts];
shared uint becomes[kMostParts];  // 8 bits for each number
shared uint totals[4];

uint firstOf(uint block) {
  while (blocks[block].parent != block) block = blocks[block].parent;
  return block;
}

void unite(uint a, uint b) {
  for (int i = 0; i < 4096; ++i) {
    a = firstOf(a);
    b = firstOf(b);
    if (a == b) return;
    uint low = min(a, b);
    uint high = max(a, b);
    uint was = atomicMin(blocks[high].parent, low);
    if (was == high) return;
    a = was;
    b = low;
  }
}

uint sizeOf(uint first) {
  return blocks[first].counts[0] + blocks[first].counts[1] + blocks[first].counts[2] +
         blocks[first].counts[3];
}

// Blocks between the boxes around two parts.
int between(uint a, uint b) {
  int x = max(int(blocks[a].left) - int(blocks[b].right), int(blocks[b].left) - int(blocks[a].right));
  int y = max(int(blocks[a].low) - int(blocks[b].high), int(blocks[b].low) - int(blocks[a].high));
  return max(max(x, y) - 1, 0);
}

uint withNumber(uint becoming, uint number, uint to) {
  uint shift = 8u * (number - 1u);
  return (becoming & ~(0xFFu << shift)) | to << shift;
}

// The mean motion of a part's mover in a frame.
vec2 motionOf(uint first, uint number) {
  uint at = 2u * (number - 1u);
  float cells = max(float(blocks[first].counts[number]), 1.0);
  return vec2(blocks[first].motion[at], blocks[first].motion[at + 1u]) / (256.0 * cells);
}

// How near each number is to a part, and the one that is least so, but for the first `passed`.
uint leastNear(uint i, uint passed, out float nearness) {
  vec3 near = vec3(0.0);
  for (uint j = 0u; j < partCount; ++j) {
    if (j == i) continue;
    float gap = float(between(parts[i], parts[j]));
    for (int number = 1; number <= 3; ++number) {
      near[number - 1] += float(blocks[parts[j]].counts[number]) / (1.0 + gap * gap);
    }
  }
  uint best = 0u;
  for (uint k = 0u; k <= passed; ++k) {
    best = near.x <= near.y && near.x <= near.z ? 1u : near.y <= near.z ? 2u : 3u;
    nearness = near[best - 1u];
    if (k < passed) near[best - 1u] = 1e9 + float(k);
  }
  return best;
}

void decide(uint i) {
  uint first = parts[i];
  uint size = sizeOf(first);
  uint major = majors[i];
  uint becoming = 1u | 2u << 8u | 3u << 16u;
  float nearness;
  if (major == 0u) {
    int nearest = kBeside + 1;
    uint rank = 0u;  // among new parts
    uint fill = 0u;
    for (uint j = 0u; j < partCount; ++j) {
      if (j == i) continue;
      int gap = between(first, parts[j]);
      if (majors[j] == 0u) {
        if (parts[j] < first && gap > kBeside) ++rank;
      } else if (gap < nearest) {
        nearest = gap;
        fill = majors[j];
      }
    }
    fills[i] = fill != 0u ? fill : leastNear(i, rank % 3u, nearness);
    becomes[i] = becoming;
    return;
  }
  uint fill = major;
  for (uint number = 1u; number <= 3u; ++number) {
    if (number == major) continue;
    uint count = blocks[first].counts[number];
    float most = float(blocks[first].counts[major]);
    bool isLeft = float(count) < kLeftOver * most && totals[number] > 3u * count;
    vec2 own = motionOf(first, number);
    vec2 other = motionOf(first, major);
    bool isAlike = float(count) >= kLeastAlike * most && length(other) > 0.6 &&
                   distance(own, other) < 0.25 * length(other) + 0.2;
    if (isLeft || isAlike) becoming = withNumber(becoming, number, major);
  }
  for (uint j = 0u; j < partCount; ++j) {
    if (j == i || majors[j] != major) continue;
    uint others = sizeOf(parts[j]);
    int gap = between(first, parts[j]);
    bool isSmaller = size < others || (size == others && parts[j] < first);
    if (!isSmaller || size < kLarge || gap < kClearly || gap > kSoonMeet) continue;
    uint least = leastNear(i, 0u, nearness);
    if (least == major || nearness > 0.5) continue;
    fill = least;
    becoming = withNumber(becoming, major, least);
  }
  fills[i] = fill;
  becomes[i] = becoming;
}

void main() {
  if (isBeyond(kPartsCommand)) return;
  uint lane = gl_LocalInvocationID.x;
  uint lanes = gl_WorkGroupSize.x;
  uint count = uint(grid.x * grid.y);
  if (lane < 4u) totals[lane] = 0u;
  barrier();
  for (uint b = lane; b < count; b += lanes) {
    if (blocks[b].parent == kNoPart) continue;
    ivec2 at = ivec2(int(b) % grid.x, int(b) / grid.x);
    for (int i = 0; i < 4; ++i) {
      ivec2 to = at + (i == 0 ? ivec2(1, 0) : ivec2(i - 2, 1));
      if (to.x < 0 || to.x >= grid.x || to.y >= grid.y) continue;
      uint other = uint(to.y * grid.x + to.x);
      if (blocks[other].parent != kNoPart) unite(b, other);
    }
  }
  memoryBarrierBuffer();
  barrier();
  for (uint b = lane; b < count; b += lanes) {
    if (blocks[b].parent == kNoPart) continue;
    uint first = firstOf(b);
    ivec2 at = ivec2(int(b) % grid.x, int(b) / grid.x);
    ivec2 size = sizeOfMotion();
    for (int i = 0; i < 4; ++i) {
      uint cells = blocks[b].counts[i];
      if (cells == 0u) continue;
      atomicAdd(totals[i], cells);
      if (i == 0) continue;
      vec3 moved = texelFetch(moverMotion, at + ivec2(0, (i - 1) * size.y), 0).xyz;
      vec2 sum = 256.0 * float(cells) * moved.xy / max(moved.z, 1e-3);
      atomicAdd(blocks[first].motion[2 * (i - 1)], int(sum.x));
      atomicAdd(blocks[first].motion[2 * (i - 1) + 1], int(sum.y));
    }
  }
  memoryBarrierBuffer();
  barrier();
  // Only then: what a part's first block has itself is counted before it has the sum.
  for (uint b = lane; b < count; b += lanes) {
    if (blocks[b].parent == kNoPart) continue;
    uint first = firstOf(b);
    if (first == b) continue;
    for (int i = 0; i < 4; ++i) {
      if (blocks[b].counts[i] != 0u) atomicAdd(blocks[first].counts[i], blocks[b].counts[i]);
    }
    atomicMin(blocks[first].low, blocks[b].low);
    atomicMax(blocks[first].high, blocks[b].high);
    atomicMin(blocks[first].left, blocks[b].left);
    atomicMax(blocks[first].right, blocks[b].right);
  }
  memoryBarrierBuffer();
  barrier();
  // In the order of places, so that each run gives the same numbers: each invocation counts those of
  // its own stretch of blocks.
  uint each = (count + lanes - 1u) / lanes;
  uint begin = min(lane * each, count);
  uint end = min(begin + each, count);
  uint own = 0u;
  for (uint b = begin; b < end; ++b) own += blocks[b].parent == b ? 1u : 0u;
  firsts[lane] = own;
  barrier();
  uint found = 0u;
  for (uint i = 0u; i < lane; ++i) found += firsts[i];
  for (uint b = begin; b < end && found < kMostParts; ++b) {
    if (blocks[b].parent != b) continue;
    parts[found] = b;
    ++found;
  }
  if (lane == lanes - 1u) partCount = min(found, kMostParts);
  barrier();
  for (uint i = lane; i < partCount; i += lanes) {
    uint first = parts[i];
    uint one = blocks[first].counts[1];
    uint two = blocks[first].counts[2];
    uint three = blocks[first].counts[3];
    uint known = one + two + three;
    uint major = one >= max(two, three) ? 1u : two >= three ? 2u : 3u;
    majors[i] = 8u * known >= sizeOf(first) && known > 0u ? major : 0u;
  }
  barrier();
  for (uint i = lane; i < partCount; i += lanes) decide(i);
  barrier();
  for (uint b = lane; b < count; b += lanes) {
    ivec2 at = ivec2(int(b) % grid.x, int(b) / grid.x);
    vec4 shown = vec4(1.0, 1.0, 2.0, 3.0);
    if (blocks[b].parent != kNoPart) {
      uint first = firstOf(b);
      for (uint i = 0u; i < partCount; ++i) {
        if (parts[i] != first) continue;
        uint becoming = becomes[i];
        shown = vec4(fills[i], becoming & 0xFFu, becoming >> 8u & 0xFFu, becoming >> 16u & 0xFFu);
      }
    }
    imageStore(numbers, at, shown / 255.0);
  }
}
