// Purpose: the style's debug views.
// Inputs:  view: VIEW_...; ink (line.frag), over white; tone (tone_blur.frag), the contours and
//          their edges; tone.glsl's curve.
// Outputs: RGBA8. Precision: highp for places.
#include "pipeline/styles/hatching/shaders/tone.glsl"
uniform sampler2D ink;
uniform sampler2D contours;
uniform sampler2D edges;
uniform int view;
uniform vec2 pixelsOfFull;
layout(location = 0) out vec4 picture;

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  vec2 px = gl_FragCoord.xy / pixelsOfFull;
  vec4 lines = texelFetch(ink, p, 0);
  vec3 rgb = vec3(1.0 - lines.a) + lines.rgb;
  if (view == VIEW_TONE) {
    vec4 seen = textureLod(tone, px / fullSize, 0.0);
    rgb = vec3(1.0 - toneAt(px, seen.w > seen.y, false));
  }
  if (view == VIEW_EDGES) rgb = vec3(0.5 + 8.0 * texelFetch(edges, p, 0).r);
  if (view == VIEW_CONTOURS) rgb = vec3(1.0 - texelFetch(contours, p, 0).r);
  picture = vec4(clamp(rgb, 0.0, 1.0), 1.0);
}
