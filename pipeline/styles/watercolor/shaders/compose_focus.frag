// Purpose: the picture with what is in focus kept crisp: drawn on the paper instead of painted.
// Inputs:  composition.glsl's; frame, the AR frame's colour, and normalFocus, its focus in A.
// Outputs: RGBA8, sRGB-coded, opaque.
// Precision: highp, as composition.glsl says.
#include "pipeline/styles/watercolor/shaders/composition.glsl"
uniform sampler2D frame;
uniform sampler2D normalFocus;
layout(location = 0) out vec4 picture;

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  vec3 crisp = onSheet(texelFetch(frame, p, 0).rgb, sheetAt(onPaper(vec2(p) + 0.5), 1.0));
  picture = vec4(mix(paintedAt(p), crisp, texelFetch(normalFocus, p, 0).a), 1.0);
}
