// Purpose: averages the camera image over time along its motion (marks/filtered_frame.h). One
//          invocation does a block of 4x4 pixels with a single displacement, so that the past of
//          all of them takes 7x7 reads.
// Inputs:  filtered_frame.glsl's; backward (marks/motion_field.h); pixelsOfFull.
// Outputs: filtered.
// Precision: highp.
#include "pipeline/gpu/shaders/pixel_block.glsl"
#include "pipeline/marks/shaders/filtered_frame.glsl"
layout(local_size_x = 16, local_size_y = 4) in;
uniform sampler2D backward;
uniform vec2 pixelsOfFull;

const float kFieldPixels = 8.0;  // marks::MotionField

ivec2 size;
ivec2 corner;
vec4 before[kBlockPixels];  // the past that belongs to each pixel
float trust[kBlockPixels];

// Catmull-Rom weights of four texels for a place f beyond the second.
vec4 weightsOf(float f) {
  return vec4(((-0.5 * f + 1.0) * f - 0.5) * f, (1.5 * f - 2.5) * f * f + 1.0,
              ((-1.5 * f + 2.0) * f + 0.5) * f, (0.5 * f - 0.5) * f * f);
}

void followPicture() {
  vec2 middle = (vec2(corner) + 2.0) / pixelsOfFull;
  vec2 fields = vec2(textureSize(backward, 0));
  vec4 moved = textureLod(backward, middle / (kFieldPixels * fields), 0.0);
  vec2 from = -moved.xy * pixelsOfFull;
  bool isKnown = moved.w > 0.5 && abs(from.x) < 4096.0 && abs(from.y) < 4096.0;
  from = isKnown ? from : vec2(0.0);
  float known = isKnown ? trustOf(moved.z * pixelsOfFull.x) : 0.0;
  vec2 whole = floor(from);
  vec4 across = weightsOf(from.x - whole.x);
  vec4 down = weightsOf(from.y - whole.y);
  ivec2 first = corner + ivec2(whole) - 1;
  for (int i = 0; i < kBlockPixels; ++i) before[i] = vec4(0.0);
  for (int row = 0; row < 7; ++row) {
    vec4 line[7];
    for (int i = 0; i < 7; ++i) {
      line[i] = texelFetch(past, clamp(first + ivec2(i, row), ivec2(0), size - 1), 0);
    }
    for (int x = 0; x < 4; ++x) {
      vec4 value = across.x * line[x] + across.y * line[x + 1] + across.z * line[x + 2] +
                   across.w * line[x + 3];
      for (int y = 0; y < 4; ++y) {
        int tap = row - y;
        if (tap >= 0 && tap < 4) before[y * 4 + x] += down[tap] * value;
      }
    }
  }
  for (int i = 0; i < kBlockPixels; ++i) {
    vec2 at = vec2(corner + inBlock(i)) + 0.5 + from;
    trust[i] = isInside(at, size) ? known * max(before[i].a, 0.0) : 0.0;
  }
}

void main() {
  size = textureSize(picture, 0);
  corner = ivec2(gl_GlobalInvocationID.xy) * kBlockSide;
  if (any(greaterThanEqual(corner, size))) return;
  followPicture();

  vec3 around[36];
  for (int i = 0; i < 36; ++i) {
    ivec2 p = clamp(corner + ivec2(i % 6, i / 6) - 1, ivec2(0), size - 1);
    around[i] = texelFetch(picture, p, 0).rgb;
  }
  vec3 sums[24];  // of three in a row: colours, then their squares
  vec3 squares[24];
  for (int i = 0; i < 24; ++i) {
    int at = (i >> 2) * 6 + (i & 3);
    vec3 a = around[at];
    vec3 b = around[at + 1];
    vec3 c = around[at + 2];
    sums[i] = a + b + c;
    squares[i] = a * a + b * b + c * c;
  }
  for (int i = 0; i < kBlockPixels; ++i) {
    vec3 now = around[(i >> 2) * 6 + (i & 3) + 7];
    vec4 average = averaged(now, before[i].rgb, trust[i], sums[i] + sums[i + 4] + sums[i + 8],
                            squares[i] + squares[i + 4] + squares[i + 8]);
    // Beyond the border: no effect.
    imageStore(filtered, corner + inBlock(i), average);
  }
}
