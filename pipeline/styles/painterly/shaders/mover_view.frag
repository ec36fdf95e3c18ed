// Purpose: debug views of what moves by itself: movers over the picture, the redder the surer, violet
//          while they rest, and blue where the background is hardly known; the second and third mover
//          have green and blue for red; or the background behind them.
// Inputs:  picture; mover_labels.glsl's, mover_shares.glsl's; background (marks::MotionLayers); size and pixelsOfFull: of
//          the frame; view: VIEW_MOVERS or VIEW_BACKGROUND.
// Outputs: RGBA8, sRGB-coded, opaque. Precision: highp for places.
uniform sampler2D picture;
uniform highp sampler2D background;
uniform vec2 size;
uniform vec2 pixelsOfFull;
uniform int view;
layout(location = 0) out vec4 colour;
#include "pipeline/marks/movers/shaders/mover_labels.glsl"
#include "pipeline/marks/movers/shaders/mover_shares.glsl"

const float kSureSeconds = 0.2;     // seen to move for so long: motion_layers.glsl's kMatureSeconds
const vec2 kRestSeconds = vec2(0.1, 1.0);
const vec2 kKnownFrames = vec2(1.0, 8.0);

void main() {
  vec2 px = gl_FragCoord.xy / pixelsOfFull;
  vec4 known = textureLod(background, inLayers(background, px), 0.0);
  vec2 mover = moverAt(px);
  vec3 seen = 0.4 + 0.6 * texture(picture, gl_FragCoord.xy / size).rgb;
  ivec2 last = textureSize(movers, 0) - 1;
  vec4 label = texelFetch(movers, min(ivec2(px / kLayerCellPixels), last), 0);
  float unknown = 1.0 - smoothstep(kKnownFrames.x, kKnownFrames.y, known.a);
  vec3 shown = mix(seen, vec3(0.2, 0.35, 0.9), 0.5 * unknown * (1.0 - mover.r));
  shown = mix(shown, vec3(0.9, 0.75, 0.1), 0.5 * mover.g);
  vec3 moving = mix(vec3(1.0, 0.6, 0.4), vec3(0.85, 0.1, 0.1), clamp(label.a / kSureSeconds, 0.0, 1.0));
  moving = mix(moving, vec3(0.45, 0.1, 0.7), smoothstep(kRestSeconds.x, kRestSeconds.y, label.b));
  int number = numberAt(px);
  moving = number == 2 ? moving.grb : number == 3 ? moving.gbr : moving;
  shown = mix(shown, moving, 0.6 * mover.r);
  if (view == VIEW_BACKGROUND) shown = known.a > 0.5 ? known.rgb : vec3(0.0);
  colour = vec4(shown, 1.0);
}
