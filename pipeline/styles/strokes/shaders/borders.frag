// Purpose: the borders at which strokes are clipped, of a whole picture (borders.glsl).
// Inputs:  borders.glsl's.
// Outputs: R32UI, packed as in stroke_border.glsl.
// Precision: integers; highp for places.
#include "pipeline/styles/strokes/shaders/borders.glsl"
layout(location = 0) out uint border;

void main() { border = borderAt(ivec2(gl_FragCoord.xy)); }
