// Purpose: a camera's Bayer mosaic becomes one picture of the same size: gradient-corrected linear
//          interpolation (Malvar, He and Cutler, ICASSP 2004).
// Inputs:  plane0 (R8), bayerOrigin: column and row (0 or 1) of the red site.
// Outputs: RGBA8, alpha 1. Precision: highp: sums of thirteen samples.
uniform sampler2D plane0;
uniform ivec2 bayerOrigin;

layout(location = 0) out vec4 colour;

// A Bayer sample, mirrored at the border so that its colour stays what it is (a side of one pixel
// has but one colour).
float mosaic(ivec2 p) {
  ivec2 last = textureSize(plane0, 0) - 1;
  p = abs(last - abs(last - abs(p)));
  return texelFetch(plane0, min(p, last), 0).r;
}

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

void main() { colour = vec4(clamp(bayer(ivec2(gl_FragCoord.xy)), 0.0, 1.0), 1.0); }
