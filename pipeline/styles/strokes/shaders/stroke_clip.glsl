// Purpose: keeps a stroke's paint inside the border of what it lies on (thesis §5.5).
// Inputs:  borders (borders.frag); label: the stroke's.
// Outputs: the share of a fragment that the stroke may paint, in [0, 1].
// Precision: integers.
#include "pipeline/styles/strokes/shaders/border.glsl"
uniform usampler2D borders;
flat in uint label;

float within() {
  uint border = texelFetch(borders, ivec2(gl_FragCoord.xy), 0).r;
  float share = shareOf(border);
  return (mayCover(label, ownOf(border)) ? share : 0.0) +
         (mayCover(label, otherOf(border)) ? 1.0 - share : 0.0);
}
