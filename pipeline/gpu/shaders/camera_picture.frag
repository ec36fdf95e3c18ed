// Purpose: a camera's planes, whatever their layout, become one sRGB-coded RGBA picture of the same
//          size.
// Inputs:  plane0..2 as uploaded (FrameUploader), `layoutKind` (FrameUploader::Layout), rgbFromYcbcr and
//          ycbcrOffset for Y'CbCr, chromaShift (texels: siting), bayerOrigin (of the red site, 0 or 1).
// Outputs: RGBA8, alpha 1.
// Precision: highp: chroma coordinates need sub-texel accuracy.
uniform sampler2D plane0;
uniform sampler2D plane1;
uniform sampler2D plane2;
uniform int layoutKind;
uniform mat3 rgbFromYcbcr;
uniform vec3 ycbcrOffset;
uniform vec2 chromaShift;
uniform ivec2 bayerOrigin;
uniform ivec2 pictureSize;

layout(location = 0) out vec4 colour;

const int kRgb = 0;
const int kGrey = 1;
const int kNv12 = 2;
const int kI420 = 3;
const int kYuyv = 4;
const int kBayer = 5;

vec3 toRgb(vec3 ycbcr) { return rgbFromYcbcr * (ycbcr - ycbcrOffset); }

vec2 chromaCoordinate(vec2 pixel, ivec2 chromaSize) {
  return (pixel * 0.5 + chromaShift) / vec2(chromaSize);
}

vec3 nv12(ivec2 p) {
  vec2 at = chromaCoordinate(vec2(p) + 0.5, textureSize(plane1, 0));
  return toRgb(vec3(texelFetch(plane0, p, 0).r, texture(plane1, at).rg));
}

vec3 i420(ivec2 p) {
  vec2 at = chromaCoordinate(vec2(p) + 0.5, textureSize(plane1, 0));
  return toRgb(vec3(texelFetch(plane0, p, 0).r, texture(plane1, at).r, texture(plane2, at).r));
}

// A texel is a pair of pixels with one chroma between them, sited as chromaShift says.
vec3 yuyv(ivec2 p) {
  int last = textureSize(plane0, 0).x - 1;
  float at = (float(p.x) + 0.5) * 0.5 + chromaShift.x - 0.5;
  int left = int(floor(at));
  vec2 leftChroma = texelFetch(plane0, ivec2(max(left, 0), p.y), 0).ga;
  vec2 rightChroma = texelFetch(plane0, ivec2(min(left + 1, last), p.y), 0).ga;
  vec4 pair = texelFetch(plane0, ivec2(p.x >> 1, p.y), 0);
  float luma = (p.x & 1) == 0 ? pair.r : pair.b;
  return toRgb(vec3(luma, mix(leftChroma, rightChroma, at - float(left))));
}

// A Bayer sample, mirrored at the border so that its colour stays what it is (a side of one pixel
// has but one colour).
float mosaic(ivec2 p) {
  ivec2 last = pictureSize - 1;
  p = abs(last - abs(last - abs(p)));
  return texelFetch(plane0, min(p, last), 0).r;
}

// Gradient-corrected linear interpolation (Malvar, He and Cutler, ICASSP 2004).
vec3 bayer(ivec2 p) {
  float c = mosaic(p);
  float n = mosaic(p + ivec2(0, -1)), s = mosaic(p + ivec2(0, 1));
  float w = mosaic(p + ivec2(-1, 0)), e = mosaic(p + ivec2(1, 0));
  float nn = mosaic(p + ivec2(0, -2)), ss = mosaic(p + ivec2(0, 2));
  float ww = mosaic(p + ivec2(-2, 0)), ee = mosaic(p + ivec2(2, 0));
  float diagonal = mosaic(p + ivec2(-1, -1)) + mosaic(p + ivec2(1, -1)) +
                   mosaic(p + ivec2(-1, 1)) + mosaic(p + ivec2(1, 1));
  float far = nn + ss + ww + ee;
  float greenAt = (4.0 * c + 2.0 * (n + s + w + e) - far) / 8.0;
  float alongRow = (5.0 * c + 4.0 * (w + e) - diagonal - (ww + ee) + 0.5 * (nn + ss)) / 8.0;
  float alongColumn = (5.0 * c + 4.0 * (n + s) - diagonal - (nn + ss) + 0.5 * (ww + ee)) / 8.0;
  float across = (6.0 * c + 2.0 * diagonal - 1.5 * far) / 8.0;
  bool redColumn = (p.x & 1) == bayerOrigin.x;
  bool redRow = (p.y & 1) == bayerOrigin.y;
  if (redRow && redColumn) return vec3(c, greenAt, across);
  if (redRow) return vec3(alongRow, c, alongColumn);
  if (redColumn) return vec3(alongColumn, c, alongRow);
  return vec3(across, greenAt, c);
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  vec3 rgb;
  if (layoutKind == kNv12) {
    rgb = nv12(p);
  } else if (layoutKind == kI420) {
    rgb = i420(p);
  } else if (layoutKind == kYuyv) {
    rgb = yuyv(p);
  } else if (layoutKind == kBayer) {
    rgb = bayer(p);
  } else if (layoutKind == kGrey) {
    rgb = texelFetch(plane0, p, 0).rrr;
  } else {
    rgb = texelFetch(plane0, p, 0).rgb;
  }
  colour = vec4(clamp(rgb, 0.0, 1.0), 1.0);
}
