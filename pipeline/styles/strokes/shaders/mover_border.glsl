// Purpose: mixes the paint of both sides of a mover's border, by the share of each pixel that the mover
//          covers. Strokes of both were drawn up to it, all or nothing: where several lie over one another,
//          the last one would count most, and the border would change with their order.
// Inputs:  borders (borders.glsl); colours: the paint.
// Outputs: functions.
// Precision: integers; that of colours.
#include "pipeline/marks/strokes/shaders/stroke_border.glsl"
uniform highp usampler2D borders;

// The paint of a pixel: at a mover's border, mixed with that of the nearest pixels of the other side.
vec3 mixedAtBorder(ivec2 p, uint border, vec3 own, sampler2D colours) {
  const int kReach = 3;  // px: as far as a border is soft
  ivec2 last = textureSize(borders, 0) - 1;
  vec4 beyond = vec4(0.0);
  // Compilers unroll no loop of unknown length, and one that no invocation enters costs little on
  // software renderers.
  int end = isMoverBorder(border) ? 9 * kReach : 0;
  for (int i = 0; i < end; ++i) {
    if (i % 9 == 0 && beyond.a > 0.0) break;
    ivec2 at = clamp(p + (1 + i / 9) * (ivec2(i % 3, i / 3 % 3) - 1), ivec2(0), last);
    if (ownOf(texelFetch(borders, at, 0).r) != otherOf(border)) continue;
    beyond += vec4(texelFetch(colours, at, 0).rgb, 1.0);
  }
  return beyond.a > 0.0 ? mix(beyond.rgb / beyond.a, own, shareOf(border)) : own;
}
