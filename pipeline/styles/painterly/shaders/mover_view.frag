// Purpose: debug views of what moves by itself: movers over the picture, or the background behind
//          them.
// Inputs:  picture; mover_labels.glsl's; background (marks::MotionLayers); size and pixelsOfFull: of
//          the frame; view: VIEW_MOVERS or VIEW_BACKGROUND.
// Outputs: RGBA8, sRGB-coded, opaque. Precision: highp for places.
uniform sampler2D picture;
uniform highp sampler2D background;
uniform vec2 size;
uniform vec2 pixelsOfFull;
uniform int view;
layout(location = 0) out vec4 colour;
#include "pipeline/marks/shaders/mover_labels.glsl"

void main() {
  vec2 px = gl_FragCoord.xy / pixelsOfFull;
  vec4 known = textureLod(background, inLayers(background, px), 0.0);
  vec2 mover = moverAt(px);
  vec3 seen = 0.4 + 0.6 * texture(picture, gl_FragCoord.xy / size).rgb;
  vec3 shown = mix(seen, vec3(0.9, 0.75, 0.1), 0.5 * mover.g);
  shown = mix(shown, vec3(0.85, 0.1, 0.1), 0.6 * mover.r);
  if (view == VIEW_BACKGROUND) shown = known.a > 0.5 ? known.rgb : vec3(0.0);
  colour = vec4(shown, 1.0);
}
