// Purpose: a camera's Y'CbCr to R'G'B'.
// Inputs:  rgbFromYcbcr and ycbcrOffset (gpu::YcbcrConversion), chromaShift: where chroma sits, in
//          chroma texels after halving the pixel's coordinate.
// Outputs: none. Precision: highp: chroma coordinates need sub-texel accuracy.
uniform mat3 rgbFromYcbcr;
uniform vec3 ycbcrOffset;
uniform vec2 chromaShift;

vec4 opaqueFromYcbcr(float luma, vec2 chroma) {
  return vec4(clamp(rgbFromYcbcr * (vec3(luma, chroma) - ycbcrOffset), 0.0, 1.0), 1.0);
}

// Where 4:2:0 chroma of a pixel is sampled.
vec2 chromaCoordinate(ivec2 pixel, ivec2 chromaSize) {
  return ((vec2(pixel) + 0.5) * 0.5 + chromaShift) / vec2(chromaSize);
}
