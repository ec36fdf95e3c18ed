// Purpose: the motion of movers without its noise from block to block: the mean of blocks around
//          that move alike (Tomasi and Manduchi, "Bilateral filtering for gray and color images",
//          1998), so that what is of one piece stays so, and a limb has a motion of its own.
// Inputs:  found (mover_motion.comp); busy_blocks.glsl's commands.
// Outputs: moverMotion: as of mover_motion.comp. One invocation per block.
// Precision: highp.
#include "pipeline/marks/movers/shaders/busy_blocks.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba16f, binding = 0) writeonly uniform highp image2D moverMotion;
uniform highp sampler2D found;

const int kReach = 3;      // blocks
const float kAlike = 1.0;  // px: at this difference, a block counts half

vec4 smoothAt(ivec2 block, ivec2 size, int row) {
  vec4 own = texelFetch(found, ivec2(block.x, row + block.y), 0);
  if (own.z <= 0.0) return vec4(0.0);
  vec2 motion = own.xy / own.z;
  vec3 sum = vec3(0.0);
  ivec2 first = max(block - kReach, ivec2(0));
  ivec2 last = min(block + kReach, size - 1);
  for (int y = first.y; y <= last.y; ++y) {
    for (int x = first.x; x <= last.x; ++x) {
      vec3 there = texelFetch(found, ivec2(x, row + y), 0).xyz;
      if (there.z <= 0.0) continue;
      vec2 apart = (there.xy / there.z - motion) / kAlike;
      vec2 away = vec2(ivec2(x, y) - block);
      float unlike = dot(apart, apart);
      sum += exp(-0.15 * dot(away, away)) / (1.0 + unlike * unlike) * there;
    }
  }
  return vec4(own.z * vec3(sum.xy / sum.z, 1.0), 0.0);
}

void main() {
  if (isBeyond(kMotionCommand)) return;
  ivec2 block = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = ivec2(imageSize(moverMotion).x, imageSize(moverMotion).y / 3);
  if (any(greaterThanEqual(block, size))) return;
  for (int row = 0; row < imageSize(moverMotion).y; row += size.y) {
    imageStore(moverMotion, ivec2(block.x, row + block.y), smoothAt(block, size, row));
  }
}
