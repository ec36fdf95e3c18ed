// Purpose: a camera's YUYV pairs become one sRGB-coded picture of the same size.
// Inputs:  plane0: a pair of pixels a texel (RGBA8: Y0 Cb Y1 Cr), those of ycbcr.glsl.
// Outputs: RGBA8, alpha 1. Precision: highp, as ycbcr.glsl.
#include "pipeline/gpu/frames/shaders/ycbcr.glsl"
uniform sampler2D plane0;

layout(location = 0) out vec4 colour;

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  int last = textureSize(plane0, 0).x - 1;
  // The pair's chroma and the next one's, on that side where the pixel lies from its site.
  float at = (float(p.x) + 0.5) * 0.5 + chromaShift.x - 0.5;
  int left = int(floor(at));
  vec2 leftChroma = texelFetch(plane0, ivec2(max(left, 0), p.y), 0).ga;
  vec2 rightChroma = texelFetch(plane0, ivec2(min(left + 1, last), p.y), 0).ga;
  vec4 pair = texelFetch(plane0, ivec2(p.x >> 1, p.y), 0);
  float luma = (p.x & 1) == 0 ? pair.r : pair.b;
  colour = opaqueFromYcbcr(luma, mix(leftChroma, rightChroma, at - float(left)));
}
