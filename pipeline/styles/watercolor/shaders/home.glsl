// Purpose: where a cell's seed is at home (thesis eq. 1), on a lattice of 1/64 px, so that distances
//          are exact integers.
// Inputs, outputs: cells (column, row); positions in px of the picture.
// Precision: highp: 1/64 px up to 8192 px.
#include "pipeline/styles/watercolor/shaders/hash.glsl"
const float kSeedUnits = 64.0;  // in a pixel

vec2 snapToLattice(vec2 position) { return floor(position * kSeedUnits + 0.5) / kSeedUnits; }

// cellPixels is (W/n, H/m).
vec2 homeOf(ivec2 cell, vec2 cellPixels, uint seed) {
  uint hash = hashOf(cell, seed);
  vec2 jitter = vec2(unitOf(hash), unitOf(hashOf(hash))) - 0.5;
  return snapToLattice(cellPixels * (vec2(cell) + 0.5 + jitter));
}
