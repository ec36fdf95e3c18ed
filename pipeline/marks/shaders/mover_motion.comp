// Purpose: the motion of movers, in blocks of cells: that which agrees best with the edges around
//          (Lucas and Kanade, "An iterative image registration technique", 1981), in a window that
//          grows over the mover until they have more than one direction.
// Inputs:  normals, normalFlow (mover_edges.comp).
// Outputs: moverMotion RGBA16F: displacement since the previous frame, less the background's (px of
//          the full image), times weight, and the weight, 0 where the mover is not near; the movers'
//          blocks are one above the other. The highest mover of busy_blocks.glsl. One invocation per
//          block.
// Precision: highp.
#include "pipeline/marks/shaders/busy_blocks.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba16f, binding = 0) writeonly uniform highp image2D moverMotion;
uniform highp sampler2D normals;
uniform highp sampler2D normalFlow;
uniform uint turn;  // as in motion_layers_tally.glsl

const float kEnough = 12.0;  // the smaller eigenvalue: some edges of both directions
const float kBalance = 0.1;  // the smaller eigenvalue, in parts of the larger one
const float kLeast = 0.5;    // the sum of both: any edges at all
const int kNearest = 2;      // blocks in which all movers count
const int kFarthest = 8;     // blocks

// Whether the mover lies all the way between two blocks: edges of another one say nothing.
bool isJoined(ivec2 from, ivec2 to, int row) {
  for (int i = 1; i < 4; ++i) {
    ivec2 at = from + ivec2(round(0.25 * float(i) * vec2(to - from)));
    if (texelFetch(normals, ivec2(at.x, row + at.y), 0).a <= 0.0) return false;
  }
  return true;
}

// The eigenvalues of the matrix (xx, xy, yy), the larger one first.
vec2 eigenvaluesOf(vec3 m) {
  float middle = 0.5 * (m.x + m.z);
  float spread = sqrt(max(0.25 * (m.x - m.z) * (m.x - m.z) + m.y * m.y, 0.0));
  return vec2(middle + spread, middle - spread);
}

// Which movers are within kNearest blocks, a bit for each.
int presentAround(ivec2 block, ivec2 size) {
  int present = 0;
  for (int y = -kNearest; y <= kNearest; ++y) {
    for (int x = -kNearest; x <= kNearest; ++x) {
      ivec2 at = clamp(block + ivec2(x, y), ivec2(0), size - 1);
      present |= int(texelFetch(normalFlow, at, 0).z + 0.5);
    }
  }
  return present;
}

vec4 motionAt(ivec2 block, ivec2 size, int row) {
  vec3 matrix = vec3(0.0);
  vec2 moved = vec2(0.0);
  vec2 values = vec2(0.0);
  int farthest = texelFetch(normals, ivec2(block.x, row + block.y), 0).a > 0.0 ? kFarthest : kNearest;
  for (int radius = 1; radius <= farthest; radius *= 2) {
    matrix = vec3(0.0);
    moved = vec2(0.0);
    float fall = 1.0 / float(radius * radius);
    for (int y = -radius; y <= radius; ++y) {
      for (int x = -radius; x <= radius; ++x) {
        ivec2 at = block + ivec2(x, y);
        if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) continue;
        vec3 there = texelFetch(normals, ivec2(at.x, row + at.y), 0).xyz;
        if (there.x + there.z <= 0.0) continue;
        if (radius > kNearest && !isJoined(block, at, row)) continue;
        float weight = exp(-fall * float(x * x + y * y));
        matrix += weight * there;
        moved += weight * texelFetch(normalFlow, ivec2(at.x, row + at.y), 0).xy;
      }
    }
    values = eigenvaluesOf(matrix);
    if (values.y > max(kEnough, kBalance * values.x)) break;
  }
  float sum = values.x + values.y;
  if (!(sum >= kLeast)) return vec4(0.0);
  // Where only one direction is seen, the other one stays near 0.
  mat2 damped = mat2(matrix.x, matrix.y, matrix.y, matrix.z) + mat2(0.01 * sum);
  vec2 displacement = inverse(damped) * moved;
  float weight = min(values.y / kEnough, 1.0) + 1e-2;
  return vec4(weight * vec3(displacement, 1.0), 0.0);
}

void main() {
  ivec2 block = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = ivec2(imageSize(moverMotion).x, imageSize(moverMotion).y / 3);
  if (any(greaterThanEqual(block, size))) return;
  int present = presentAround(block, size);
  for (int i = 0; i < 3; ++i) {
    int row = i * size.y;
    vec4 motion = vec4(0.0);
    if ((present & (1 << i)) != 0) motion = motionAt(block, size, row);
    imageStore(moverMotion, ivec2(block.x, row + block.y), motion);
    if (motion.z > 0.0) atomicMax(busyWords[kHighestMover + int(turn)], uint(i + 1));
  }
}
