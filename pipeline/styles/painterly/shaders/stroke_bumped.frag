// Purpose: like stroke.frag, with each stroke lit by itself.
// Inputs, outputs: stroke_mark.glsl's, stroke_bump.glsl's.
// Precision: as there.
#include "pipeline/styles/painterly/shaders/stroke_mark.glsl"
#include "pipeline/styles/painterly/shaders/stroke_bump.glsl"

void main() {
  vec2 place = brushPlace();
  vec2 texel = texture(brushes, place).rg;
  leave(bumped(pigment(texel.g), place), texel.g, paint.a * texel.r);
}
