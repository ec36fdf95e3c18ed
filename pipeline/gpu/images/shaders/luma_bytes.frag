// Purpose: the luma of a camera's frame as bytes, as the processor would have read them.
// Inputs:  plane0: the frame's first plane as it is imported (R8; RGBA8 for RGBA and for pairs of YUYV).
// Outputs: RGBA8: bytes 4x .. 4x + 3 of a row of luma; beyond its end the last one again.
//          Precision: highp, integers: equal to OpenCV's conversion to the bit.
// Defines: YUYV: a texel is Y0 Cb Y1 Cr. RGBA: a texel is a pixel. BYTES: RGB of single bytes, three
//          times as wide. None: a texel is luma.
uniform sampler2D plane0;
uniform ivec2 frameSize;

layout(location = 0) out vec4 packedBytes;

int byteOf(float value) { return int(value * 255.0 + 0.5); }

// BT.601's weights in 1/32768 (OpenCV, RGB2GRAY).
int grey(ivec3 rgb) { return (9798 * rgb.r + 19235 * rgb.g + 3735 * rgb.b + 16384) >> 15; }

#ifdef YUYV
int lumaAt(ivec2 p) {
  vec4 pair = texelFetch(plane0, ivec2(p.x >> 1, p.y), 0);
  return byteOf((p.x & 1) == 0 ? pair.r : pair.b);
}
#else
#ifdef RGBA
int lumaAt(ivec2 p) {
  vec4 pixel = texelFetch(plane0, p, 0);
  return grey(ivec3(byteOf(pixel.r), byteOf(pixel.g), byteOf(pixel.b)));
}
#else
#ifdef BYTES
int lumaAt(ivec2 p) {
  ivec2 at = ivec2(3 * p.x, p.y);
  return grey(ivec3(byteOf(texelFetch(plane0, at, 0).r),
                    byteOf(texelFetch(plane0, at + ivec2(1, 0), 0).r),
                    byteOf(texelFetch(plane0, at + ivec2(2, 0), 0).r)));
}
#else
int lumaAt(ivec2 p) { return byteOf(texelFetch(plane0, p, 0).r); }
#endif
#endif
#endif

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  ivec4 columns = min(4 * texel.x + ivec4(0, 1, 2, 3), ivec4(frameSize.x - 1));
  ivec4 bytes = ivec4(lumaAt(ivec2(columns.x, texel.y)), lumaAt(ivec2(columns.y, texel.y)),
                      lumaAt(ivec2(columns.z, texel.y)), lumaAt(ivec2(columns.w, texel.y)));
  packedBytes = vec4(bytes) / 255.0;
}
