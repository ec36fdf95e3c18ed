// Purpose: for each pixel the nearest seed (thesis §3.2.1; a seed that is fading in has a smaller
//          cell: a power diagram) and the edge strength (eq. 2-4), and for each cell the sums for
//          its mean colour and its next tiling. Movers have cells of their own: all else is tiled
//          first, then they. One invocation does a block of 4x4 pixels and adds once per cell in the
//          block.
// Defines: has_objects.glsl's.
// Inputs:  picture (sRGB-coded), ids (R32UI) if hasObjects; sorted, starts, bins, binPixels: the
//          seeds (seed_point.glsl, marks/anchors/point_bins.h); moverGroups (seeds.comp), mover_labels.glsl's
//          and pixelsOfFull; ofMovers: whether movers are tiled, or all else; alpha, beta, threshold;
//          wantsMeans: whether colours are summed, too.
// Outputs: tiling (R32UI, tiling_word.glsl), sums (cell_sums.glsl).
// Precision: integers for distances and sums, so that order does not matter; of equally near seeds
//          the first in `sorted` wins. Distances of more than about 100 px (fewer, where seeds are
//          crowded) are rounded, so that they fit beside the number of a seed.
#include "pipeline/gpu/shaders/colour.glsl"
#include "pipeline/gpu/images/shaders/luma.glsl"
#include "pipeline/gpu/images/shaders/pixel_block.glsl"
#include "pipeline/marks/movers/shaders/mover_labels.glsl"
#include "pipeline/marks/anchors/shaders/point_bins.glsl"
#include "pipeline/scene/render/shaders/has_objects.glsl"
#include "pipeline/scene/render/shaders/object_id.glsl"
#include "pipeline/styles/watercolor/shaders/cell_sums.glsl"
#include "pipeline/styles/watercolor/shaders/seed_point.glsl"
#include "pipeline/styles/watercolor/shaders/tiling_word.glsl"
layout(local_size_x = 16, local_size_y = 4) in;
layout(std430, binding = 0) readonly buffer Starts { uint starts[]; };
layout(std430, binding = 1) buffer Sums { uint sums[]; };
layout(std430, binding = 2) readonly buffer Sorted { ivec4 sorted[]; };
layout(std430, binding = 3) readonly buffer MoverGroups { uint moverGroups[]; };
layout(binding = 0, r32ui) writeonly uniform highp uimage2D tiling;
uniform sampler2D picture;
uniform highp usampler2D ids;
uniform float alpha;
uniform float beta;
uniform float threshold;
uniform bool wantsMeans;
uniform bool ofMovers;
uniform vec2 pixelsOfFull;

const int kStrip = 2;  // columns
const float kHalfDiagonal = 2.1213204;  // between the block's middle and its corner pixels' centres

ivec2 size;
ivec2 corner;  // the block's first pixel
ivec2 low;     // the bins of the seeds that the block's pixels may be of
ivec2 high;
uint nearest[kBlockPixels];  // the number of its seed among those, plus one; later its name
uint edges;   // a bit for each edge pixel
uvec4 codes;  // strengths of edges, 8 bits for each pixel of a row, as codeOf() makes them

const uint kNamed = 0x80000000u;

vec2 middle() { return vec2(corner) + 2.0; }

// The range of the points in bins `low` to `high` of a row, which are contiguous.
uvec2 rangeOf(ivec2 low, ivec2 high, int row) {
  int first = row * bins.x;
  return uvec2(starts[first + low.x], starts[first + high.x + 1]);
}

// The pixels of the block that are tiled in this run, a bit for each: those within the picture that
// show movers, or those that show none.
uint ownPixels() {
  const float kSure = 0.05;
  ivec2 end = min(ivec2(kBlockSide), size - corner);
  uint own = (1u << end.x) - 1u;
  own |= own << 4u;
  own |= own << 8u;
  own &= (1u << uint(kBlockSide * end.y)) - 1u;
  if (moverGroups[2] == 0u) return own;
  vec2 range = vec2(1.0, 0.0);
  for (int i = 0; i < 4; ++i) {
    vec2 away = vec2(4 * (i & 1) - 2, 4 * (i >> 1) - 2);
    float label = moverAt((middle() + away) / pixelsOfFull).r;
    range = vec2(min(range.x, label), max(range.y, label));
  }
  uint onMovers = range.x > 1.0 - kSure ? own : 0u;
  int mixed = range.y > kSure && onMovers == 0u ? kBlockPixels : 0;
  for (int i = 0; i < mixed; ++i) {
    vec2 px = (vec2(corner + inBlock(i)) + 0.5) / pixelsOfFull;
    onMovers |= moverAt(px).r > 0.5 ? 1u << i : 0u;
  }
  return own & (ofMovers ? onMovers : ~onMovers);
}

// An upper bound on the distance from the block's middle to any seed that owns a pixel of the
// block. One near seed gives it. Where no seed of this run is near, all seeds count.
float findReach(out bool allCount) {
  const int kNear = 4;  // rings of bins
  ivec2 here = binOf(middle());
  // nearly always a single round; wider rings where there are no seeds
  allCount = false;
  for (int ring = 1;; ring *= 2) {
    ivec2 low = max(here - ring, ivec2(0));
    ivec2 high = min(here + ring, bins - 1);
    float near = 1.0e12;
    for (int row = low.y; row <= high.y; ++row) {
      uvec2 range = rangeOf(low, high, row);
      for (uint i = range.x; i < range.y; ++i) {
        ivec4 point = sorted[i];
        if (isOnMover(point) != ofMovers && !allCount) continue;
        vec2 apart = vec2(point.xy) * (1.0 / kPointUnits) - middle();
        float far = length(apart) + kHalfDiagonal;
        near = min(near, far * far + float(point.z) * (1.0 / (kPointUnits * kPointUnits)));
      }
    }
    bool isAll = low == ivec2(0) && high == bins - 1;
    if (near < 1.0e12 || (isAll && allCount)) return sqrt(near) + kHalfDiagonal + 0.03;
    allCount = allCount || isAll || ring >= kNear;
  }
}

// Distances are kept with the numbers of their seeds below them, in one word a pixel: registers are
// few. Squared ones differ from |s|² − 2 p·s by |p|² alone, and that is linear in p.
void findNearest(uint own) {
  bool allCount;
  float reach = findReach(allCount);
  low = binOf(middle() - reach);
  high = binOf(middle() + reach);
  uint count = 0u;
  for (int row = low.y; row <= high.y; ++row) {
    uvec2 range = rangeOf(low, high, row);
    count += range.y - range.x;
  }
  int bits = max(findMSB(count) + 1, 4);  // of a number
  // Of those that may be nearest, to the block's first pixel, and the largest to any of its pixels.
  float far = kPointUnits * (reach + 5.3);
  float farthest = kPointUnits * (reach + 10.6);
  const int kBelow = 131072;  // more than |p|²
  float most = log2(farthest * farthest + float(kBelow)) + float(bits);
  int coarser = int(ceil(max(0.0, 0.5 * (most - 31.99))));
  int unit = 64 >> coarser;
  int limit = int(far * far * exp2(-2.0 * float(coarser)));
  for (int i = 0; i < kBlockPixels; ++i) nearest[i] = 0xFFFFFFFFu;
  uint number = 0u;
  for (int row = low.y; row <= high.y; ++row) {
    uvec2 range = rangeOf(low, high, row);
    for (uint k = range.x; k < range.y; ++k, ++number) {
      ivec4 point = sorted[k];
      if (isOnMover(point) != ofMovers && !allCount) continue;
      ivec2 s = (point.xy - corner * 64) >> coarser;
      if (any(greaterThan(abs(s), ivec2(23000)))) continue;  // squares would not fit
      int start = s.x * s.x + s.y * s.y - unit * (s.x + s.y) + (point.z >> (2 * coarser));
      if (start > limit) continue;
      uint first = uint(start + (kBelow >> (2 * coarser))) << bits | number;
      uvec2 across = uvec2(2 * unit * s) << bits;
      for (int i = 0; i < kBlockPixels; ++i) {
        nearest[i] = min(nearest[i], first - uint(i & 3) * across.x - uint(i >> 2) * across.y);
      }
    }
  }
  uint numbers = (1u << bits) - 1u;
  for (int i = 0; i < kBlockPixels; ++i) {
    nearest[i] = (own >> i & 1u) != 0u ? (nearest[i] & numbers) + 1u : 0u;
  }
}

// The slot of a seed, plus one.
uint nameOf(uint number) {
  for (int row = low.y; row <= high.y; ++row) {
    uvec2 range = rangeOf(low, high, row);
    if (number < range.y - range.x) return uint(sorted[range.x + number].w) + 1u;
    number -= range.y - range.x;
  }
  return 1u;  // there are no seeds
}

ivec2 inPicture(ivec2 at) { return clamp(at, ivec2(0), size - 1); }

// One direction's part of eq. 2 and 3, which are sums over the two directions of ∇. YUV is ITU-R
// BT.601's Y', Cb, Cr.
float differenceOf(vec3 a, vec3 b) {
  vec3 d = a - b;
  float y = lumaOf(d);
  float u = (d.b - y) * (1.0 / 1.772);
  float v = (d.r - y) * (1.0 / 1.402);
  float yuv = (1.0 - alpha) * abs(y) + alpha * 0.5 * (abs(u) + abs(v));
  float rgb = (abs(d.r) + abs(d.g) + abs(d.b)) * (1.0 / 3.0);
  return (beta * yuv + (1.0 - beta) * rgb) * 0.5;
}

// Whether objects meet at a pixel: a bit for each pixel of the block. Row by row, in a loop that
// compilers do not unroll, so that two rows are held and not six; findEdges() likewise.
uint silhouettesOf() {
  uint met = 0u;
  uvec4 above = uvec4(0u);
  uvec4 here = uvec4(0u);
  uint beside = 0u;
  int rows = min(kBlockSide, size.y - corner.y);
  for (int row = -1; row <= rows; ++row) {
    uint objects[kBlockSide + 2];
    for (int x = 0; x < kBlockSide + 2; ++x) {
      uint id = texelFetch(ids, inPicture(corner + ivec2(x - 1, row)), 0).r;
      uint object = objectOf(id);
      objects[x] = object < kRealObject ? object : 0u;  // real content has its own edges
    }
    uvec4 below = uvec4(objects[1], objects[2], objects[3], objects[4]);
    if (row > 0) {
      for (int x = 0; x < kBlockSide; ++x) {
        bool isMet = below[x] != above[x] || (beside >> x & 1u) != 0u;
        met |= isMet ? 1u << (kBlockSide * (row - 1) + x) : 0u;
      }
    }
    above = here;
    here = below;
    beside = 0u;
    for (int x = 0; x < kBlockSide; ++x) beside |= objects[x] != objects[x + 2] ? 1u << x : 0u;
  }
  return met;
}

// Finds `edges` and `codes`, two columns at a time.
void findEdges() {
  uint silhouettes = hasObjects ? silhouettesOf() : 0u;
  edges = 0u;
  codes = uvec4(0u);
  ivec2 end = min(ivec2(kBlockSide), size - corner);
  for (int left = 0; left < end.x; left += kStrip) {
    vec3 above[kStrip];
    vec3 here[kStrip];
    vec2 across = vec2(0.0);
    for (int x = 0; x < kStrip; ++x) above[x] = here[x] = vec3(0.0);
    for (int row = -1; row <= end.y; ++row) {
      vec3 colours[kStrip + 2];
      for (int x = 0; x < kStrip + 2; ++x) {
        colours[x] = texelFetch(picture, inPicture(corner + ivec2(left + x - 1, row)), 0).rgb;
      }
      if (row > 0) {
        uint code = 0u;
        for (int x = 0; x < kStrip; ++x) {
          uint pixel = 1u << (kBlockSide * (row - 1) + left + x);
          float strength = across[x] + differenceOf(colours[x + 1], above[x]);
          bool silhouette = (silhouettes & pixel) != 0u;
          edges |= strength > threshold || silhouette ? pixel : 0u;
          code |= codeOf(silhouette ? 1.0 : strength) << (8 * (left + x));
        }
        codes[row - 1] |= code;
      }
      for (int x = 0; x < kStrip; ++x) {
        above[x] = here[x];
        here[x] = colours[x + 1];
        across[x] = differenceOf(colours[x + 2], colours[x]);
      }
    }
  }
}

void addColour(uint index, uvec3 colour) {
  atomicAdd(sums[index], colour.r);
  atomicAdd(sums[index + 1u], colour.g);
  atomicAdd(sums[index + 2u], colour.b);
}

// `places`: sums of x and y in the block, and the count, packed: 8 bits each, the count from bit 16.
void addPlaces(uint places, uint x, uint y, uint count) {
  uint number = places >> 16u;
  atomicAdd(sums[x], (places & 0xFFu) + number * uint(corner.x));
  atomicAdd(sums[y], ((places >> 8u) & 0xFFu) + number * uint(corner.y));
  atomicAdd(sums[count], number);
}

void main() {
  if (ofMovers && moverGroups[2] == 0u) return;
  size = textureSize(picture, 0);
  corner = ivec2(gl_GlobalInvocationID.xy) * kBlockSide;
  if (any(greaterThanEqual(corner, size))) return;
  uint own = ownPixels();
  if (own == 0u) return;
  findEdges();
  findNearest(own);

  // Cell by cell, from the highest number down, without branches.
  for (uint above = kNamed;;) {
    uint number = 0u;
    for (int i = 0; i < kBlockPixels; ++i) number = max(number, nearest[i] < above ? nearest[i] : 0u);
    if (number == 0u) break;
    uint name = nameOf(number - 1u);
    uint places = 0u;
    uint edgePlaces = 0u;
    uint members = 0u;  // a bit for each pixel
    for (int i = 0; i < kBlockPixels; ++i) {
      ivec2 here = inBlock(i);
      uint place = nearest[i] == number ? uint(here.x | (here.y << 8) | (1 << 16)) : 0u;
      places += place;
      members |= place != 0u ? 1u << i : 0u;
      edgePlaces += (edges >> i & 1u) != 0u ? place : 0u;
      nearest[i] = place != 0u ? kNamed | name : nearest[i];
    }
    uint index = (name - 1u) * uint(kSumWords);
    addPlaces(places, index + 7u, index + 8u, index + 3u);
    if (edgePlaces != 0u) addPlaces(edgePlaces, index + 4u, index + 5u, index + 6u);
    if (wantsMeans) {
      uvec3 colour = uvec3(0u);
      for (int i = 0; members >> i != 0u; ++i) {
        uint taken = (members >> i & 1u) != 0u ? 0xFFFFFFFFu : 0u;
        vec3 srgb = texelFetch(picture, inPicture(corner + inBlock(i)), 0).rgb;
        colour += uvec3(linearFromSrgbFast(srgb) * kLinearUnits + 0.5) & taken;
      }
      addColour(index, colour);
    }
    above = number;
  }

  for (int i = 0; i < kBlockPixels; ++i) {
    uint code = codes[i >> 2] >> (8 * (i & 3)) & 0xFFu;
    uint slot = (nearest[i] & ~kNamed) - 1u;
    uint word = packTiling(slot & kSlotBits, (edges >> i & 1u) != 0u, code);
    if (nearest[i] != 0u) imageStore(tiling, corner + inBlock(i), uvec4(word, 0u, 0u, 0u));
  }
}
