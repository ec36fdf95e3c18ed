// Purpose: keeps a stroke's paint inside the border of what it lies on (thesis §5.5).
// Inputs:  borders (borders.glsl); label: the stroke's.
// Outputs: the share of a fragment that the stroke may paint, in [0, 1]: smooth, and for paint of which
//          mover_border.glsl mixes both sides afterwards: at a mover's border all or nothing; and
//          whether it is such a border.
// Precision: integers.
#include "pipeline/marks/strokes/shaders/stroke_border.glsl"
uniform usampler2D borders;
flat in uint label;

struct Within {
  float smoothly;
  float toBeMixed;
  bool isMixed;
};

Within within() {
  uint border = texelFetch(borders, ivec2(gl_FragCoord.xy), 0).r;
  float share = shareOf(border);
  float ofOwn = isOpen(border) ? 1.0 : share;
  float ofOther = isOpen(border) ? share : 1.0 - share;
  bool mayOwn = mayCover(label, ownOf(border));
  // Both, where the stroke has no segment and may cover either.
  float covered = min((mayOwn ? ofOwn : 0.0) + (mayCover(label, otherOf(border)) ? ofOther : 0.0), 1.0);
  bool isMixed = isMoverBorder(border);
  return Within(covered, isMixed ? (mayOwn ? 1.0 : 0.0) : covered, isMixed);
}
