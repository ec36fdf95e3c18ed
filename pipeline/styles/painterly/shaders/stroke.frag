// Purpose: the paint that a brush leaves, and how thick it lies.
// Defines: BUMPED: each stroke is in the light by itself. CLIPPED: no paint lies beyond the boundary
//          of what a stroke is of, in frames that show models.
// Inputs, outputs: stroke_mark.glsl's; BUMPED: stroke_bump.glsl's; CLIPPED: stroke_clip.glsl's.
// Precision: as there.
#include "pipeline/styles/painterly/shaders/stroke_mark.glsl"
#ifdef BUMPED
#include "pipeline/styles/painterly/shaders/stroke_bump.glsl"
#endif
#ifdef CLIPPED
#include "pipeline/styles/painterly/shaders/stroke_clip.glsl"
#endif

void main() {
  vec2 place = brushPlace();
  vec2 texel = texture(brushes, place).rg;
  vec3 rgb = pigment(texel.g);
  float cover = paint.a * texel.r;
#ifdef BUMPED
  rgb = bumped(rgb, place);
#endif
#ifdef CLIPPED
  cover = cover * within();
#endif
  leave(rgb, texel.g, cover);
}
