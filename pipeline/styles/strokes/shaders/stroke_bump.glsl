// Purpose: lights each stroke by itself, as in the thesis (§4.4): the normal comes from finite
//          differences of the brush's height, in the stroke's tangent frame.
// Inputs:  relief, gloss: weights; stroke_mark.glsl's; along: the stroke's direction; sense: of the
//          brush across it.
// Outputs: the lit paint.
// Precision: mediump suffices.
#include "pipeline/styles/strokes/shaders/paint_light.glsl"
uniform float relief;
uniform float gloss;
in vec2 along;

vec3 bumped(vec3 rgb, vec2 place) {
  float left = textureOffset(brushes, place, ivec2(-1, 0)).g;
  float right = textureOffset(brushes, place, ivec2(1, 0)).g;
  float bottom = textureOffset(brushes, place, ivec2(0, -1)).g;
  float top = textureOffset(brushes, place, ivec2(0, 1)).g;
  vec2 onward = normalize(along);
  vec2 across = sign(sense) * vec2(-onward.y, onward.x);
  vec2 tilt = relief * ((left - right) * onward + (bottom - top) * across);
  vec3 normal = normalize(vec3(tilt, 1.0));
  return clamp(inLight(rgb, litBy(normal)) + gloss * shineOf(normal), 0.0, 1.0);
}
