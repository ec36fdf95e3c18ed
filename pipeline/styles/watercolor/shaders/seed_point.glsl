// Purpose: a seed as a point that is sorted into bins (marks/point.glsl), with what it paints:
//          movers, or all else.
// Inputs, outputs: the lowest bit of the penalty: whether it is a mover's.
// Precision: integers are exact; penalties, to two of their units.
#include "pipeline/marks/shaders/point.glsl"

ivec4 seedPoint(vec2 px, float penalty, int slot, bool isOnMover) {
  ivec4 point = pointAt(px, penalty, slot);
  point.z = (point.z & ~1) | (isOnMover ? 1 : 0);
  return point;
}
int sideOf(ivec4 point) { return point.z & 1; }
