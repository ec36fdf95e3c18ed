// Purpose: the place of a slot in the texture of shifts.
// Inputs:  a slot.
// Outputs: its texel.
// Precision: integers.
const uint kJustBorn = 0x10000u;  // of a point (line_points.comp)
const int kShiftColumns = 128;

ivec2 shiftTexel(int slot) { return ivec2(slot % kShiftColumns, slot / kShiftColumns); }
