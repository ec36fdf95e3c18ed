// Purpose: converts an image's pixels to the values of a memory layout; shared by the packing passes.
// Inputs:  picture (LINEAR, of the output's size), ycbcrFromRgb and ycbcrOffset
//          (gpu::YcbcrConversion), chromaLeftSited.
// Outputs: none. Precision: highp: colours keep 8 bits through the matrix.
uniform sampler2D picture;
uniform mat3 ycbcrFromRgb;
uniform vec3 ycbcrOffset;
uniform int chromaLeftSited;

vec3 rgbAt(ivec2 p) { return texelFetch(picture, min(p, textureSize(picture, 0) - 1), 0).rgb; }

float lumaAt(ivec2 p) { return dot(transpose(ycbcrFromRgb)[0], rgbAt(p)) + ycbcrOffset.x; }

// Chroma of the pair of columns 2 * pair and 2 * pair + 1 at height y. A bilinear tap between two
// columns is their mean; for left-sited chroma, two taps give the 1 : 2 : 1 mean around the even
// one.
vec2 chromaAt(int pair, float y) {
  vec2 size = vec2(textureSize(picture, 0));
  float right = float(2 * pair + 1);
  vec3 rgb = texture(picture, vec2(right, y) / size).rgb;
  if (chromaLeftSited != 0) rgb = 0.5 * (rgb + texture(picture, vec2(right - 1.0, y) / size).rgb);
  return (ycbcrFromRgb * rgb + ycbcrOffset).yz;
}

// Chroma of row `row` in 4:2:0: the mean of two rows of the image.
vec2 chroma420(int pair, int row) { return chromaAt(pair, float(2 * row + 1)); }
