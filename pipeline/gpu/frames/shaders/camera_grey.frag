// Purpose: a camera's grey picture becomes an RGBA one.
// Inputs:  plane0 (R8).
// Outputs: RGBA8, alpha 1. Precision: colours pass through.
uniform sampler2D plane0;

layout(location = 0) out vec4 colour;

void main() { colour = vec4(texelFetch(plane0, ivec2(gl_FragCoord.xy), 0).rrr, 1.0); }
