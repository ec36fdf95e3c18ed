// Purpose: for each pixel the nearest seed (thesis §3.2.1) and the edge strength (eq. 2-4), and for
//          each cell the sums that its mean colour and its re-tiling need. One invocation does a
//          block of 4x4 pixels and adds once per cell that the block holds.
// Inputs:  picture (RGBA8, sRGB-coded), ids (R32UI) if hasObjects, seeds, grid (n, m), cellPixels,
//          alpha, beta, threshold; wantsMeans: whether colours are summed, too.
// Outputs: tiling (R32UI, tiling_word.glsl), sums: per cell 8 words, linear R, G, B in 1/16384,
//          pixels, and over edge pixels x, y, count; one spare.
// Precision: integers for distances and sums, so that order does not matter and ties go to the
//          lower index.
#include "pipeline/styles/watercolor/shaders/tiling_word.glsl"
layout(local_size_x = 16, local_size_y = 4) in;
layout(std430, binding = 0) readonly buffer Seeds { vec2 seeds[]; };
layout(std430, binding = 1) buffer Sums { uint sums[]; };
layout(binding = 0, r32ui) writeonly uniform highp uimage2D tiling;
uniform sampler2D picture;
uniform highp usampler2D ids;
uniform bool hasObjects;
uniform ivec2 grid;
uniform vec2 cellPixels;
uniform float alpha;
uniform float beta;
uniform float threshold;
uniform bool wantsMeans;

const int kSide = 4;
const int kPixels = 16;
const uint kTriangleBits = 22u;  // scene::kTriangleBits
const uint kRealObject = 512u;   // scene::kRealObject
const float kHalfDiagonal = 2.1213204;  // between the block's middle and its corner pixels' centres

ivec2 size;
ivec2 corner;  // the block's first pixel
uint nearest[kPixels];  // the cell, as in a tiling word, plus one

// Squared distance from the block's middle.
float fromMiddle(ivec2 cell) {
  vec2 apart = seeds[cell.y * grid.x + cell.x] - (vec2(corner) + 2.0);
  return dot(apart, apart);
}

// What no seed outside the searched rows and columns is nearer than, given that seeds stay within
// one cell of their own cell's middle.
float nearestUnsearched(ivec2 low, ivec2 high) {
  vec2 middle = vec2(corner) + 2.0;
  vec2 before = middle - (vec2(low) + 0.5) * cellPixels;
  vec2 after = (vec2(high) + 0.5) * cellPixels - middle;
  float far = 1.0e6;
  if (low.x > 0) far = min(far, before.x);
  if (low.y > 0) far = min(far, before.y);
  if (high.x < grid.x - 1) far = min(far, after.x);
  if (high.y < grid.y - 1) far = min(far, after.y);
  return far;
}

// Squared distances differ from |s|² − 2 p·s by |p|² alone, and that is linear in p.
void findNearest() {
  ivec2 here = clamp(ivec2((vec2(corner) + 2.0) / cellPixels), ivec2(0), grid - 1);
  // One near seed bounds how far the nearest can be from any pixel of the block.
  ivec2 low = max(here - 1, ivec2(0));
  ivec2 high = min(here + 1, grid - 1);
  float near = 1.0e12;
  for (int row = low.y; row <= high.y; ++row) {
    for (int column = low.x; column <= high.x; ++column) {
      near = min(near, fromMiddle(ivec2(column, row)));
    }
  }
  float reach = sqrt(near) + 2.0 * kHalfDiagonal + 0.03;
  for (int ring = 2;; ++ring) {  // 5x5 nearly always; wider where seeds have moved apart
    low = max(here - ring, ivec2(0));
    high = min(here + ring, grid - 1);
    if (reach < nearestUnsearched(low, high)) break;
  }
  float reachSquared = reach * reach;
  int best[kPixels];
  for (int i = 0; i < kPixels; ++i) {
    best[i] = 0x7FFFFFFF;
    nearest[i] = 0u;
  }
  for (int row = low.y; row <= high.y; ++row) {
    for (int column = low.x; column <= high.x; ++column) {
      ivec2 cell = ivec2(column, row);
      if (fromMiddle(cell) > reachSquared) continue;
      uint name = packCell(cell) + 1u;
      ivec2 s = ivec2((seeds[row * grid.x + column] - vec2(corner)) * 64.0);
      int start = s.x * s.x + s.y * s.y - 64 * (s.x + s.y);
      for (int i = 0; i < kPixels; ++i) {
        int value = start - 128 * ((i & 3) * s.x + (i >> 2) * s.y);
        nearest[i] = value < best[i] ? name : nearest[i];
        best[i] = min(best[i], value);
      }
    }
  }
}

ivec2 inPicture(ivec2 at) { return clamp(at, ivec2(0), size - 1); }

// Eq. 2 and 3 are sums over the two directions of ∇: one direction's part.
// YUV is ITU-R BT.601's Y', Cb, Cr.
float differenceOf(vec4 a, vec4 b) {
  vec3 d = a.rgb - b.rgb;
  float y = dot(d, vec3(0.299, 0.587, 0.114));
  float u = (d.b - y) * (1.0 / 1.772);
  float v = (d.r - y) * (1.0 / 1.402);
  float yuv = (1.0 - alpha) * abs(y) + alpha * 0.5 * (abs(u) + abs(v));
  float rgb = (abs(d.r) + abs(d.g) + abs(d.b)) * (1.0 / 3.0);
  return (beta * yuv + (1.0 - beta) * rgb) * 0.5;
}

// IEC 61966-2-1 with y^0.4 as a polynomial: within 0.2/255 of the exact curve.
vec3 linearFromSrgbFast(vec3 srgb) {
  vec3 y = (srgb + 0.055) * (1.0 / 1.055);
  vec3 root = ((((2.121072 * y - 6.588469) * y + 8.066004) * y - 5.157318) * y + 2.353418) * y +
              0.206812;
  return mix(y * y * root, srgb * (1.0 / 12.92), lessThanEqual(srgb, vec3(0.04045)));
}

void addColour(uint index, uvec4 colour) {
  atomicAdd(sums[index * 8u], colour.r);
  atomicAdd(sums[index * 8u + 1u], colour.g);
  atomicAdd(sums[index * 8u + 2u], colour.b);
  atomicAdd(sums[index * 8u + 3u], colour.a);
}

void addEdges(uint index, uint edges) {
  if (edges == 0u) return;
  uint count = edges >> 16u;
  atomicAdd(sums[index * 8u + 4u], (edges & 0xFFu) + count * uint(corner.x));
  atomicAdd(sums[index * 8u + 5u], ((edges >> 8u) & 0xFFu) + count * uint(corner.y));
  atomicAdd(sums[index * 8u + 6u], count);
}

void main() {
  size = textureSize(picture, 0);
  corner = ivec2(gl_GlobalInvocationID.xy) * kSide;
  if (any(greaterThanEqual(corner, size))) return;
  findNearest();

  vec4 block[36];  // colours, and objects in alpha
  ivec2 first = corner - 1;
  for (int i = 0; i < 36; ++i) {
    vec3 colour = texelFetch(picture, inPicture(first + ivec2(i % 6, i / 6)), 0).rgb;
    block[i] = vec4(colour, 0.0);
  }
  if (hasObjects) {
    for (int i = 0; i < 36; ++i) {
      uint id = texelFetch(ids, inPicture(first + ivec2(i % 6, i / 6)), 0).r;
      uint object = id >> kTriangleBits;
      block[i].a = object < kRealObject ? float(object) : 0.0;  // real things have their own edges
    }
  }

  uint edge[kPixels];  // of an edge pixel x, y in the block and 1, 8 bits each
  for (int i = 0; i < kPixels; ++i) {
    int at = (i >> 2) * 6 + (i & 3) + 7;
    ivec2 inBlock = ivec2(i & 3, i >> 2);
    float strength = differenceOf(block[at + 1], block[at - 1]) +
                     differenceOf(block[at + 6], block[at - 6]);
    bool silhouette = block[at + 1].a != block[at - 1].a || block[at + 6].a != block[at - 6].a;
    bool isEdge = strength > threshold || silhouette;
    edge[i] = isEdge ? uint(inBlock.x | (inBlock.y << 8) | (1 << 16)) : 0u;
    uint word = packTiling(nearest[i] - 1u, isEdge, silhouette ? 1.0 : strength);
    imageStore(tiling, corner + inBlock, uvec4(word, 0u, 0u, 0u));  // beyond the border: no effect
    if (any(greaterThanEqual(corner + inBlock, size))) nearest[i] = 0u;
  }

  // Cell by cell, from the highest down, without branches.
  for (uint above = 0xFFFFFFFFu;;) {
    uint name = 0u;
    for (int i = 0; i < kPixels; ++i) name = max(name, nearest[i] < above ? nearest[i] : 0u);
    if (name == 0u) break;
    uint edges = 0u;
    for (int i = 0; i < kPixels; ++i) edges += nearest[i] == name ? edge[i] : 0u;
    ivec2 cell = cellOf(name - 1u);
    uint index = uint(cell.y * grid.x + cell.x);
    addEdges(index, edges);
    if (wantsMeans) {
      uvec4 colour = uvec4(0u);
      for (int i = 0; i < kPixels; ++i) {
        uint taken = nearest[i] == name ? 0xFFFFFFFFu : 0u;
        vec3 srgb = block[(i >> 2) * 6 + (i & 3) + 7].rgb;
        colour += uvec4(uvec3(linearFromSrgbFast(srgb) * 16384.0 + 0.5), 1u) & taken;
      }
      addColour(index, colour);
    }
    above = name;
  }
}
