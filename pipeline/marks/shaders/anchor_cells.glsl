// Purpose: the anchor counts of each cell of the density grid.
// Inputs, outputs: places in px of the full image; cells row by row.
// Precision: integers; highp for places.
struct Cell {
  uint inImage;  // staying anchors in the camera image, also those that movers cover
  uint onObjects;  // staying anchors on virtual objects
  uint nextToRemove;  // age and slot of the next anchor to remove
  uint strata;  // the occupied parts of the cell: 16 bits for the image, 16 for objects
  // wanted spawns: 16 bits for the image, 8 for objects, 8 for patches of objects without anchors
  uint births;
  uint firstBirth;  // index in the frame's spawns
  uint onMovers;  // staying anchors on movers
  uint nextMoverToRemove;
  uint moverBirths;
  uint patches;  // which patches of objects have staying anchors (patchBit())
};

// Of the patch with this label (surface_form.glsl). Neighbours' differ, but for one pair in 31.
uint patchBit(uint label) { return 1u << (label % 31u); }
uint birthsInImage(uint births) { return births & 0xFFFFu; }
uint birthsOnObjects(uint births) { return births >> 16u & 0xFFu; }
uint birthsOnPatches(uint births) { return births >> 24u; }

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
