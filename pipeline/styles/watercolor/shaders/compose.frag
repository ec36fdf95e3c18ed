// Purpose: the watercolor picture without mosaic and focus, for most looks. They are a define and not a
//          branch, because software renderers run both sides of a branch.
// Defines: MOSAIC: flat cells mixed in (the thesis's mosaic), and content in focus kept sharp: drawn on
//          the paper instead of painted.
// Inputs:  composition.glsl's. MOSAIC: palette.glsl's; means (linear); mosaic in [0, 1]; frame, the
//          AR frame's colour; hasFocus, and then normalFocus with the frame's focus in A.
// Outputs: RGBA8, sRGB-coded, opaque.
// Precision: highp, as in composition.glsl.
#include "pipeline/styles/watercolor/shaders/composition.glsl"
#ifdef MOSAIC
#include "pipeline/gpu/shaders/colour.glsl"
#include "pipeline/styles/watercolor/shaders/palette.glsl"
uniform sampler2D means;
uniform sampler2D frame;
uniform sampler2D normalFocus;
uniform bool hasFocus;
uniform float vividness;
uniform float luminosity;
uniform float mosaic;
#endif
layout(location = 0) out vec4 picture;

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  vec4 substrate = sheetAt(onPaper(gl_FragCoord.xy), 1.0);
#ifdef MOSAIC
  ivec2 cell = texelOf(slotOf(texelFetch(tiling, p, 0).r));
  vec3 mean = srgbFromLinear(texelFetch(means, cell, 0).rgb);
  vec3 wash = mix(washAt(p, substrate), painted(mean, vividness, luminosity), mosaic);
  vec3 crisp = onSubstrate(texelFetch(frame, p, 0).rgb, substrate);
  float focus = hasFocus ? texelFetch(normalFocus, p, 0).a : 0.0;
  picture = vec4(mix(finished(wash, p, substrate), crisp, focus), 1.0);
#else
  picture = vec4(finished(washAt(p, substrate), p, substrate), 1.0);
#endif
}
