// Purpose: stroke_bumped.frag and stroke_clipped.frag in one.
// Inputs, outputs: theirs.
// Precision: as there.
#include "pipeline/styles/painterly/shaders/stroke_mark.glsl"
#include "pipeline/styles/painterly/shaders/stroke_bump.glsl"
#include "pipeline/styles/painterly/shaders/stroke_clip.glsl"

void main() {
  vec2 place = brushPlace();
  vec2 texel = texture(brushes, place).rg;
  leave(bumped(pigment(texel.g), place), texel.g, paint.a * texel.r * within());
}
