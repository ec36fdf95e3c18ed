// Purpose: the anchor counts of each cell of the density grid.
// Inputs, outputs: places in px of the full image; cells row by row.
// Precision: integers; highp for places.
struct Cell {
  uint inImage;  // staying anchors in the camera image, also those that movers cover
  uint onObjects;  // staying anchors on virtual objects
  uint nextInImage;  // key of the next anchor to remove in the camera image (removalKey()); 0: none
  uint strata;  // the occupied parts of the cell: 16 bits for the image, 16 for objects
  // wanted spawns: 6 bits for the image, 10 for the factor of its target, 8 for objects, 8 for patches
  // of objects without anchors
  uint births;
  uint firstBirth;  // index in the frame's spawns
  uint onMovers;  // staying anchors on movers
  uint nextOnMovers;  // of movers
  uint moverBirths;  // wanted spawns on movers and the factor, as in the lowest bits of births
  uint patches;  // which patches of objects have staying anchors (patchBit())
  uint crowdedPatches;  // which have two or more
  uint nextOnObjects;  // as nextInImage, of virtual objects
  uint nextToWake;  // key of the next dormant anchor to wake (wakingKey()); 0: none
  // visible dormant anchors: 16 bits for all, 16 for those on patches without any staying anchor
  uint dormant;
  uint underModels;  // staying anchors in the camera image that models cover; not counted above
  uint nextUnderModels;  // as nextInImage, of these
};

// Of the patch with this label (surface_form.glsl). Neighbours' differ, but for one pair in 31.
uint patchBit(uint label) { return 1u << (label % 31u); }
const float kFactorUnits = 64.0;
uint birthsWith(uint number, float factor) {
  return min(number, 63u) | uint(clamp(factor * kFactorUnits + 0.5, 1.0, 1023.0)) << 6u;
}
uint birthsInImage(uint births) { return births & 63u; }
float factorOf(uint births) { return float(births >> 6u & 1023u) / kFactorUnits; }
uint birthsOnObjects(uint births) { return births >> 16u & 0xFFu; }
uint birthsOnPatches(uint births) { return births >> 24u; }


// Keys of slots, the largest of which comes first; never 0. Their numbers are below 2^20.
const uint kSlotBits = 20u;
const uint kKeyRankShift = 6u;  // ranks are compared by 1/16 octave
const uint kKeyRanks = 1023u;
uint slotOf(uint key) { return key & ((1u << kSlotBits) - 1u); }
// The highest rank goes first, and the only anchor of a patch last.
uint removalKey(uint slot, uint rank, bool isOnly) {
  return (isOnly ? 1u : 2u) << 30u | (rank >> kKeyRankShift) << kSlotBits | slot;
}
// The lowest rank wakes first, before all others on a patch that has no anchor.
uint wakingKey(uint slot, uint rank, bool isFirst) {
  return (isFirst ? 2u : 1u) << 30u | (kKeyRanks - (rank >> kKeyRankShift)) << kSlotBits | slot;
}
bool wakesOnEmptyPatch(uint key) { return key >> 31u != 0u; }

uniform ivec2 grid;
uniform int cellPixels;  // side of a cell
uniform int strataSide;  // parts along a cell's side, at most 4

ivec2 cellAt(vec2 px) { return ivec2(floor(px / float(cellPixels))); }
bool isInGrid(ivec2 cell) {
  return all(greaterThanEqual(cell, ivec2(0))) && all(lessThan(cell, grid));
}
int indexOf(ivec2 cell) { return cell.y * grid.x + cell.x; }
uint stratumAt(vec2 px, ivec2 cell) {
  vec2 part = px / float(cellPixels) - vec2(cell);
  ivec2 at = clamp(ivec2(part * float(strataSide)), ivec2(0), ivec2(strataSide - 1));
  return uint(at.y * strataSide + at.x);
}
