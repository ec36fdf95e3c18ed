// Purpose: a seed as a point that is sorted into bins (marks/anchors/shaders/point.glsl).
// Inputs, outputs: as of marks/anchors/shaders/point.glsl; the lowest bit of the penalty says whether the seed is on
//          a mover.
// Precision: integers are exact; penalties, to two of their units.
#include "pipeline/marks/anchors/shaders/point.glsl"

ivec4 seedPoint(vec2 px, float penalty, int slot, bool onMover) {
  ivec4 point = pointAt(px, penalty, slot);
  point.z = (point.z & ~1) | (onMover ? 1 : 0);
  return point;
}
bool isOnMover(ivec4 point) { return (point.z & 1) != 0; }
