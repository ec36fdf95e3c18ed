// Purpose: a picture as the bytes of a memory layout, four of them a texel, so that one read-back
//          brings every plane.
// Inputs:  picture (NEAREST reads), pictureSize, `layoutKind` (PictureReader), ycbcrFromRgb and
//          ycbcrOffset, chromaLeftSited.
// Outputs: RGBA8: bytes 4x .. 4x + 3 of packed row y. Rows: the planes one below the other.
// Precision: highp: colours keep 8 bits through the matrix.
uniform sampler2D picture;
uniform ivec2 pictureSize;
uniform int layoutKind;
uniform mat3 ycbcrFromRgb;
uniform vec3 ycbcrOffset;
uniform int chromaLeftSited;

layout(location = 0) out vec4 packedBytes;

const int kRgba = 0;
const int kRgb = 1;
const int kGrey = 2;
const int kI420 = 3;
const int kNv12 = 4;
const int kYuyv = 5;

vec3 rgbAt(ivec2 p) { return texelFetch(picture, clamp(p, ivec2(0), pictureSize - 1), 0).rgb; }

float lumaAt(ivec2 p) { return dot(transpose(ycbcrFromRgb)[0], rgbAt(p)) + ycbcrOffset.x; }

// Chroma of the pixel pair at even column x of row y.
vec2 chroma422(int x, int y) {
  vec3 rgb = chromaLeftSited != 0
                 ? 0.25 * (rgbAt(ivec2(x - 1, y)) + 2.0 * rgbAt(ivec2(x, y)) + rgbAt(ivec2(x + 1, y)))
                 : 0.5 * (rgbAt(ivec2(x, y)) + rgbAt(ivec2(x + 1, y)));
  return (ycbcrFromRgb * rgb + ycbcrOffset).yz;
}

vec2 chroma420(ivec2 c) { return 0.5 * (chroma422(2 * c.x, 2 * c.y) + chroma422(2 * c.x, 2 * c.y + 1)); }

float byteAt(int column, int row) {
  if (layoutKind == kRgb) return rgbAt(ivec2(column / 3, row))[column % 3];
  if (row < pictureSize.y) return lumaAt(ivec2(column, row));
  int chromaRows = (pictureSize.y + 1) / 2;
  int chromaRow = row - pictureSize.y;
  if (layoutKind == kNv12) return chroma420(ivec2(column / 2, chromaRow))[column % 2];
  return chromaRow < chromaRows ? chroma420(ivec2(column, chromaRow)).x
                                : chroma420(ivec2(column, chromaRow - chromaRows)).y;
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  if (layoutKind == kRgba) {
    packedBytes = vec4(rgbAt(texel), 1.0);
  } else if (layoutKind == kYuyv) {
    int x = 2 * texel.x;
    vec2 chroma = chroma422(x, texel.y);
    packedBytes = vec4(lumaAt(ivec2(x, texel.y)), chroma.x, lumaAt(ivec2(x + 1, texel.y)), chroma.y);
  } else {
    int column = 4 * texel.x;
    packedBytes = vec4(byteAt(column, texel.y), byteAt(column + 1, texel.y),
                       byteAt(column + 2, texel.y), byteAt(column + 3, texel.y));
  }
}
