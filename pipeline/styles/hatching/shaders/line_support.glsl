// Purpose: what a line is drawn on, and must not leave.
// Inputs:  an anchor's surface and state.
// Outputs: a virtual object's number; 0 for the background, kOnMover for movers.
// Precision: integers.
#include "pipeline/scene/render/shaders/object_id.glsl"
const uint kOnMover = 511u;  // in place of an object
const uint kJustBorn = 0x10000u;

uint supportOf(uint surface, uint state) {
  uint object = objectOf(surface);
  if (isVirtual(object)) return object;
  return (state & kMover) != 0u ? kOnMover : 0u;
}
