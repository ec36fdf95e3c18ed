// Purpose: a camera's RGB or RGBA picture becomes an opaque one.
// Inputs:  plane0 (RGB8 or RGBA8).
// Outputs: RGBA8, alpha 1. Precision: colours pass through.
uniform sampler2D plane0;

layout(location = 0) out vec4 colour;

void main() { colour = vec4(texelFetch(plane0, ivec2(gl_FragCoord.xy), 0).rgb, 1.0); }
