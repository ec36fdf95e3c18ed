// Purpose: the watercolor image without mosaic and focus, for most presets.
// Inputs:  composition.glsl's.
// Outputs: RGBA8, sRGB-coded, opaque.
// Precision: highp, as in composition.glsl.
#include "pipeline/styles/watercolor/shaders/composition.glsl"
layout(location = 0) out vec4 picture;

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  vec4 substrate = sheetAt(onPaper(gl_FragCoord.xy), 1.0);
  picture = vec4(finished(washAt(p, substrate), p, substrate), 1.0);
}
