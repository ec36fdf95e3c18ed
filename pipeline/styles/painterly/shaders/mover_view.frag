// Purpose: debug views of what moves by itself: movers over the picture, or the background behind
//          them.
// Inputs:  picture; movers, background (marks::MotionLayers); size; view: VIEW_MOVERS or
//          VIEW_BACKGROUND.
// Outputs: RGBA8, sRGB-coded, opaque. Precision: mediump suffices for colours.
uniform sampler2D picture;
uniform sampler2D movers;
uniform sampler2D background;
uniform vec2 size;
uniform int view;
layout(location = 0) out vec4 colour;

void main() {
  vec2 at = gl_FragCoord.xy / size;
  vec4 known = texture(background, at);
  vec2 mover = texture(movers, at).rg;
  vec3 seen = 0.4 + 0.6 * texture(picture, at).rgb;
  vec3 shown = mix(seen, vec3(0.9, 0.75, 0.1), 0.5 * mover.g);
  shown = mix(shown, vec3(0.85, 0.1, 0.1), 0.6 * mover.r);
  if (view == VIEW_BACKGROUND) shown = known.a > 0.5 ? known.rgb : vec3(0.0);
  colour = vec4(shown, 1.0);
}
