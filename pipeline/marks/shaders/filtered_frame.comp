// Purpose: averages the camera image over time along its motion (marks/filtered_frame.h). One
//          invocation does a block of 4x4 pixels with a single displacement. Where that leads from
//          pixels to pixels, as before a camera that stands, the past of each is one read; else two
//          columns are done at a time, and down these with the last rows kept, so that the past of
//          eight pixels takes 5x7 reads.
// Inputs:  filtered_frame.glsl's; backward (marks/motion_field.h); pixelsOfFull.
// Outputs: filtered.
// Precision: highp.
#include "pipeline/gpu/images/shaders/pixel_block.glsl"
#include "pipeline/marks/shaders/filtered_frame.glsl"
layout(local_size_x = 16, local_size_y = 4) in;
uniform sampler2D backward;
uniform vec2 pixelsOfFull;

const float kFieldPixels = 8.0;  // marks::MotionField
const int kStrip = 2;  // pixels of a row that are done together: more have no room in registers

// Catmull-Rom weights of four texels for a place f beyond the second.
vec4 weightsOf(float f) {
  return vec4(((-0.5 * f + 1.0) * f - 0.5) * f, (1.5 * f - 2.5) * f * f + 1.0,
              ((-1.5 * f + 2.0) * f + 0.5) * f, (0.5 * f - 0.5) * f * f);
}

vec4 unpacked(uvec2 halves) { return vec4(unpackHalf2x16(halves.x), unpackHalf2x16(halves.y)); }

ivec2 size;
ivec2 corner;  // of the block
vec2 from;  // from a pixel to its past
float trust;

vec4 pastAt(ivec2 at) { return texelFetch(past, clamp(at, ivec2(0), size - 1), 0); }

// Beyond the border it has no effect.
void store(ivec2 p, vec4 before) {
  vec3 sum = vec3(0.0);
  vec3 squares = vec3(0.0);
  vec3 now = vec3(0.0);
  for (int row = -1; row <= 1; ++row) {
    vec3 threeSum = vec3(0.0);
    vec3 threeSquares = vec3(0.0);
    for (int column = -1; column <= 1; ++column) {
      vec3 colour = texelFetch(picture, clamp(p + ivec2(column, row), ivec2(0), size - 1), 0).rgb;
      threeSum += colour;
      threeSquares += colour * colour;
      if (row == 0 && column == 0) now = colour;
    }
    sum += threeSum;
    squares += threeSquares;
  }
  float known = isInside(vec2(p) + 0.5 + from, size) ? trust * max(before.a, 0.0) : 0.0;
  imageStore(filtered, p, averaged(now, before.rgb, known, sum, squares));
}

void averageMoved(int x) {
  ivec2 offset = ivec2(floor(from)) - 1;
  vec2 part = from - floor(from);
  // The past, filtered along three rows; the fourth joins them.
  uvec2 rows[3 * kStrip];  // halves
  for (int i = 0; i < 3 * kStrip; ++i) rows[i] = uvec2(0u);
  for (int y = corner.y - 3; y < corner.y + kBlockSide; ++y) {
    vec4 line[kStrip + 3];
    for (int i = 0; i < kStrip + 3; ++i) line[i] = pastAt(ivec2(x + i, y + 3) + offset);
    vec4 across = weightsOf(part.x);
    vec4 down = weightsOf(part.y);
    for (int i = 0; i < kStrip; ++i) {
      vec4 fourth = across.x * line[i] + across.y * line[i + 1] + across.z * line[i + 2] +
                    across.w * line[i + 3];
      line[i] = down.x * unpacked(rows[i]) + down.y * unpacked(rows[kStrip + i]) +
                down.z * unpacked(rows[2 * kStrip + i]) + down.w * fourth;
      rows[i] = rows[kStrip + i];
      rows[kStrip + i] = rows[2 * kStrip + i];
      rows[2 * kStrip + i] = uvec2(packHalf2x16(fourth.xy), packHalf2x16(fourth.zw));
    }
    uvec4 pasts = uvec4(packHalf2x16(line[0].xy), packHalf2x16(line[0].zw),
                         packHalf2x16(line[1].xy), packHalf2x16(line[1].zw));
    // As many as there are: of the rows before the block, none.
    int count = y < corner.y ? 0 : kStrip;
    for (int i = 0; i < count; ++i) store(ivec2(x + i, y), unpacked(i == 0 ? pasts.xy : pasts.zw));
  }
}

void main() {
  size = textureSize(picture, 0);
  corner = ivec2(gl_GlobalInvocationID.xy) * kBlockSide;
  if (any(greaterThanEqual(corner, size))) return;
  vec2 middle = (vec2(corner) + 2.0) / pixelsOfFull;
  vec2 fields = vec2(textureSize(backward, 0));
  vec4 moved = textureLod(backward, middle / (kFieldPixels * fields), 0.0);
  from = -moved.xy * pixelsOfFull;
  bool isKnown = moved.w > 0.5 && abs(from.x) < 4096.0 && abs(from.y) < 4096.0;
  from = isKnown ? from : vec2(0.0);
  trust = isKnown ? trustOf(moved.z * pixelsOfFull.x) : 0.0;

  // Two loops in place of a branch, of which software renderers run both sides; of a loop that no
  // invocation enters they run one round.
  bool isOnPixels = from == floor(from);
  for (int i = isOnPixels ? 0 : kBlockPixels; i < kBlockPixels; ++i) {
    ivec2 p = corner + inBlock(i);
    store(p, pastAt(p + ivec2(from)));
  }
  int end = corner.x + kBlockSide;
  for (int x = isOnPixels ? end : corner.x; x < end; x += kStrip) averageMoved(x);
}
