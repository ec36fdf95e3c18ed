// Purpose: the motion of movers, in blocks of cells: that which agrees best with what is seen around
//          (Lucas and Kanade, "An iterative image registration technique", 1981), in windows from
//          the widest to the narrowest. What a window does not show, as along a single edge, stays
//          as the wider one has it, and what that does not, as it was: so a plain coat goes with its
//          outline, and a leg by itself.
// Inputs:  normals, normalFlow (mover_edges.comp, mover_registration.comp); earlier: what was found
//          before, of which earlierScale (this step over its) is expected, and less where it was not
//          clear: fade; damping: in each window, the weight of the wider one's motion, in parts of
//          what is seen; busy_blocks.glsl's commands.
// Outputs: moverMotion RGBA16F: displacement since the previous frame, less the background's (px of
//          the full image), times weight, and the weight, 0 where the mover is not near; the movers'
//          blocks are one above the other. The highest mover of busy_blocks.glsl. One invocation per
//          block.
// Precision: highp.
#include "pipeline/marks/movers/shaders/busy_blocks.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba16f, binding = 0) writeonly uniform highp image2D moverMotion;
uniform highp sampler2D normals;
uniform highp sampler2D normalFlow;
uniform highp sampler2D earlier;
uniform float earlierScale;
uniform float fade;
uniform float damping;
uniform uint turn;  // as in motion_layers_tally.glsl

const float kEnough = 12.0;  // the smaller eigenvalue: some edges of both directions
const float kLeast = 0.5;    // the sum of both: any edges at all
const float kClear = 0.1;    // weight of what was found before: no need to look far
const float kPrior = 0.2;    // weight of the wider window's motion, as of an edge
const float kFarPrior = 0.1; // the same in windows that look far
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

// What was found before around a block, above all where both directions were seen; and how clear
// it was in the block itself.
vec3 earlierAround(ivec2 block, ivec2 size, int row) {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 9; ++i) {
    ivec2 arm = ivec2(i % 3, i / 3) - 1;
    ivec2 at = block + arm;
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) continue;
    float weight = exp(-0.7 * float(arm.x * arm.x + arm.y * arm.y));
    sum += weight * texelFetch(earlier, ivec2(at.x, row + at.y), 0).xyz;
  }
  float clear = texelFetch(earlier, ivec2(block.x, row + block.y), 0).z;
  // What nobody sees going on may have stopped.
  float scale = earlierScale * mix(fade, 1.0, min(clear, 1.0));
  return vec3(sum.z > 0.0 ? scale * sum.xy / sum.z : vec2(0.0), clear);
}

vec4 motionAt(ivec2 block, ivec2 size, int row) {
  vec3 expected = earlierAround(block, size, row);
  vec2 displacement = expected.xy;
  vec2 values = vec2(0.0);
  float seen = 0.0;
  bool isHere = texelFetch(normals, ivec2(block.x, row + block.y), 0).a > 0.0;
  int farthest = isHere && expected.z <= kClear ? kFarthest : kNearest;
  for (int radius = farthest; radius >= 1; radius /= 2) {
    vec3 matrix = vec3(0.0);
    vec2 moved = vec2(0.0);
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
    vec2 here = eigenvaluesOf(matrix);
    float sum = here.x + here.y;
    if (radius >= kNearest) seen = max(seen, sum);
    if (radius == kNearest) values = here;
    float prior = damping * sum + (radius > kNearest ? kFarPrior : kPrior);
    mat2 damped = mat2(matrix.x, matrix.y, matrix.y, matrix.z) + mat2(prior);
    displacement = inverse(damped) * (moved + prior * displacement);
  }
  if (!(seen >= kLeast)) return vec4(0.0);
  float weight = min(values.y / kEnough, 1.0) + 1e-2;
  return vec4(weight * vec3(displacement, 1.0), 0.0);
}

void main() {
  if (isBeyond(kMotionCommand)) return;
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
