// Purpose: the paint of a brush mark and its thickness.
// Defines: BUMPED: each stroke is lit by itself. CLIPPED: for a frame with models: no paint beyond
//          the border of what it lies on.
// Inputs, outputs: stroke_mark.glsl's; BUMPED: stroke_bump.glsl's; CLIPPED: colour_clip.glsl's and
//          stroke_clip.glsl's.
// Precision: as there.
#include "pipeline/styles/strokes/shaders/stroke_mark.glsl"
#ifdef BUMPED
#include "pipeline/styles/strokes/shaders/stroke_bump.glsl"
#endif
#ifdef CLIPPED
#include "pipeline/styles/strokes/shaders/colour_clip.glsl"
#include "pipeline/styles/strokes/shaders/stroke_clip.glsl"
#endif

void main() {
  vec2 place = brushPlace();
  vec2 texel = markAt(place);
  vec3 rgb = pigment(texel.g);
  float cover = paint.a * texel.r;
#ifdef CLIPPED
  Within share = within();
  cover *= shareOfColour(paint.rgb, goesByItself(label), share.isMixed);
#endif
#ifdef BUMPED
  rgb = bumped(rgb, place);
#endif
  float body = cover;
#ifdef CLIPPED
  cover *= share.toBeMixed;
  body *= share.smoothly;
#endif
  leave(rgb, texel.g, cover, body);
}
