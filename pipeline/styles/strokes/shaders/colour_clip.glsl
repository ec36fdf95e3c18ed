// Purpose: keeps the paint of strokes on models and movers, which change more than those of the rest
//          of the picture, off places where the picture is of quite another colour, so that small things
//          are not painted over by what is beside them (Litwinowicz, "Processing images and video for
//          an impressionist effect", 1997, section 2.2: strokes are clipped at edges).
// Inputs:  picture: reduced; colourClip: by how much, 0: not at all; byLuma: paint of a limited
//          palette has hues of its own; targetSize: px.
// Outputs: the share of a stroke's paint that is left at a fragment.
// Precision: mediump suffices, except for places.
#include "pipeline/gpu/images/shaders/luma.glsl"
#include "pipeline/marks/shaders/colour_difference.glsl"
uniform sampler2D picture;
uniform float colourClip;
uniform bool byLuma;
uniform vec2 targetSize;

// From no clear difference to a clear one.
const vec2 kClear = vec2(0.04, 0.22);
// The same at a mover's border. The picture mixes the colours of both sides there, as the paint will, so
// that small differences say nothing. A label that reaches beyond its mover has the ground's colour alone.
const vec2 kClearAtBorder = vec2(0.3, 0.5);

float shareOfColour(vec3 rgb, bool isAtBorder) {
  float share = 1.0;
  if (colourClip > 0.0) {
    vec3 seen = texture(picture, gl_FragCoord.xy / targetSize).rgb;
    vec3 other = byLuma ? vec3(lumaOf(rgb - seen)) : rgb - seen;
    vec2 clear = isAtBorder ? kClearAtBorder : kClear;
    share -= colourClip * smoothstep(clear.x, clear.y, weightedLength(other));
  }
  return share;
}
