// Purpose: where a cell's seed is at home (thesis eq. 1), on a lattice of 1/64 px, so that distances
//          are exact integers.
// Inputs, outputs: cells (column, row); positions in px of the picture; cellPixels: (W/n, H/m).
// Precision: highp: 1/64 px up to 8192 px.
#include "pipeline/gpu/shaders/hash.glsl"
const float kSeedUnits = 64.0;  // in a pixel

vec2 snapToLattice(vec2 position) { return floor(position * kSeedUnits + 0.5) / kSeedUnits; }

// cellPixels is (W/n, H/m).
vec2 homeOf(ivec2 cell, vec2 cellPixels, uint seed) {
  uint hash = hashOf(cell, seed);
  vec2 jitter = vec2(unitOf(hash), unitOf(hashOf(hash))) - 0.5;
  return snapToLattice(cellPixels * (vec2(cell) + 0.5 + jitter));
}

// At most one cell from home and from the cell's own middle, which bounds the search of tile.comp,
// and in the picture; bounds go inwards to the lattice unless they are on it but for rounding.
vec2 clampedSeed(vec2 position, ivec2 cell, vec2 home, ivec2 grid, vec2 cellPixels) {
  vec2 middle = (vec2(cell) + 0.5) * cellPixels;
  vec2 low = max(max(home, middle) - cellPixels, vec2(0.0));
  vec2 high = min(min(home, middle) + cellPixels, cellPixels * vec2(grid));
  low = ceil(low * kSeedUnits - 0.01) / kSeedUnits;
  high = floor(high * kSeedUnits + 0.01) / kSeedUnits;
  return clamp(snapToLattice(position), low, high);
}
