// Purpose: whose edges those of the image are.
// Inputs:  mover_labels.glsl's (included here); places in px of the full image.
// Outputs: parts of a pixel's edge in [0, 1]: the background's, and a mover's. A mover's outline is
//          its own.
// Precision: highp.
#include "pipeline/marks/movers/shaders/mover_labels.glsl"

vec2 edgePartsAt(vec2 px) {
  const float kOutline = 3.0;  // px
  float mover = moverAt(px).r;
  float around = mover;
  for (int i = 0; i < 4; ++i) {
    around = max(around, moverAt(px + kOutline * (2.0 * vec2(i & 1, i >> 1) - 1.0)).r);
  }
  return vec2(1.0 - around, mover);
}
