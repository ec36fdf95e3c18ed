// Purpose: a camera's I420 planes become one sRGB-coded picture of the same size.
// Inputs:  plane0: Y (R8), plane1: Cb, plane2: Cr (R8, LINEAR), those of ycbcr.glsl.
// Outputs: RGBA8, alpha 1. Precision: highp, as ycbcr.glsl.
#include "pipeline/gpu/frames/shaders/ycbcr.glsl"
uniform sampler2D plane0;
uniform sampler2D plane1;
uniform sampler2D plane2;

layout(location = 0) out vec4 colour;

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  vec2 at = chromaCoordinate(p, textureSize(plane1, 0));
  vec2 chroma = vec2(texture(plane1, at).r, texture(plane2, at).r);
  colour = opaqueFromYcbcr(texelFetch(plane0, p, 0).r, chroma);
}
