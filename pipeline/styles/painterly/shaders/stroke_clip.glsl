// Purpose: paint that does not run over the boundary of what its stroke is of (thesis §5.5).
// Inputs:  borders (borders.frag); object: the stroke's.
// Outputs: how much of a fragment is the stroke's to paint, in [0, 1].
// Precision: integers.
#include "pipeline/styles/painterly/shaders/border.glsl"
uniform usampler2D borders;
flat in uint object;

float within() {
  uint border = texelFetch(borders, ivec2(gl_FragCoord.xy), 0).r;
  float share = shareOf(border);
  return ownOf(border) == object ? share : (otherOf(border) == object ? 1.0 - share : 0.0);
}
