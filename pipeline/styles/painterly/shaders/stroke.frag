// Purpose: the paint of a brush mark and its thickness.
// Inputs, outputs: stroke_mark.glsl's.
// Precision: as there.
#include "pipeline/styles/painterly/shaders/stroke_mark.glsl"

void main() {
  vec2 texel = texture(brushes, brushPlace()).rg;
  leave(pigment(texel.g), texel.g, paint.a * texel.r);
}
