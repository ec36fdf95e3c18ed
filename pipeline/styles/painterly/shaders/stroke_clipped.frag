// Purpose: like stroke.frag, for a frame with models: no paint beyond an object's border.
// Inputs, outputs: stroke_mark.glsl's, stroke_clip.glsl's.
// Precision: as there.
#include "pipeline/styles/painterly/shaders/stroke_mark.glsl"
#include "pipeline/styles/painterly/shaders/stroke_clip.glsl"

void main() {
  vec2 texel = texture(brushes, brushPlace()).rg;
  leave(pigment(texel.g), texel.g, paint.a * texel.r * within());
}
