// Purpose: the paint of a brush mark and its thickness.
// Defines: BUMPED: each stroke is lit by itself. CLIPPED: no paint beyond the border of what the stroke
//          lies on. CARRIED: on a model or a mover; software renderers go through both sides of a
//          condition, and most strokes need neither colour_clip.glsl nor soft bristles.
// Inputs, outputs: stroke_mark.glsl's; BUMPED: stroke_bump.glsl's; CLIPPED: stroke_clip.glsl's, and
//          with CARRIED colour_clip.glsl's.
// Precision: as there.
#include "pipeline/styles/strokes/shaders/stroke_mark.glsl"
#ifdef BUMPED
#include "pipeline/styles/strokes/shaders/stroke_bump.glsl"
#endif
#ifdef CLIPPED
#include "pipeline/styles/strokes/shaders/stroke_clip.glsl"
#ifdef CARRIED
#include "pipeline/styles/strokes/shaders/colour_clip.glsl"
#endif
#endif

void main() {
  vec2 place = brushPlace();
  vec2 texel = markAt(place);
  vec3 rgb = pigment(texel.g);
  float cover = paint.a * texel.r;
#ifdef CLIPPED
  Within share = within();
#ifdef CARRIED
  cover *= shareOfColour(paint.rgb, share.isMixed);
#endif
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
