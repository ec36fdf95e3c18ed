// Purpose: a point that is sorted into bins (marks/anchors/point_bins.h), on a lattice, so that integers hold
//          it exactly.
// Inputs, outputs: ivec4: x, y in 1/kPointUnits px, penalty in 1/kPointUnits² px², slot (below 0: no
//          point).
// Precision: integers are exact.
const float kPointUnits = 64.0;

const ivec4 kNoPoint = ivec4(0, 0, 0, -1);
ivec4 pointAt(vec2 px, float penalty, int slot) {
  return ivec4(ivec2(floor(px * kPointUnits + 0.5)), int(penalty * (kPointUnits * kPointUnits)), slot);
}
vec2 pointPlace(ivec4 point) { return vec2(point.xy) / kPointUnits; }
