// Purpose: debug view of the paint's thickness.
// Inputs:  heights (stroke_mark.glsl).
// Outputs: RGBA8, grey, opaque.
// Precision: mediump suffices.
uniform sampler2D heights;
layout(location = 0) out vec4 picture;

void main() { picture = vec4(vec3(texelFetch(heights, ivec2(gl_FragCoord.xy), 0).r), 1.0); }
