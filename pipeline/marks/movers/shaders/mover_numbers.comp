// Purpose: the mover that each cell of movers belongs to: what was carried there, what most cells
//          around it of its colour have, or that of its part.
// Inputs:  labels, picture: this frame's, in cells; carried (mover_carry.comp); numbers
//          (mover_parts.comp).
// Outputs: shares RGBA8: 1 for the mover, 1 to 3. A group of invocations per block of the second
//          list of busy_blocks.glsl; elsewhere it has been cleared.
// Precision: highp.
#include "pipeline/marks/movers/shaders/busy_blocks.glsl"
#include "pipeline/marks/shaders/colour_difference.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba8, binding = 0) writeonly uniform highp image2D shares;
uniform highp sampler2D labels;
uniform highp sampler2D picture;
uniform highp sampler2D carried;
uniform highp sampler2D numbers;
uniform int reach;  // 1, of the cells around; a uniform, so that compilers keep loops over them

const float kAlike = 0.04;  // of colour: at this difference, a cell counts half
const int kFarthest = 8;    // cells
const float kEnough = 0.5;  // of votes: fewer are of cells of other colours

void main() {
  if (isBeyond(kBusyCommand)) return;
  ivec2 block = blockOf(busyWords[busyAt(int(gl_WorkGroupID.x))]);
  ivec2 cell = block * kLayerBlock + ivec2(gl_LocalInvocationID.xy);
  ivec2 size = imageSize(shares);
  if (any(greaterThanEqual(cell, size))) return;
  if (texelFetch(labels, cell, 0).r < 0.5) return;
  vec4 part = floor(255.0 * texelFetch(numbers, block, 0) + 0.5);
  vec3 now = texelFetch(picture, cell, 0).rgb;
  vec3 votes = vec3(0.0);
  for (int stride = 1; stride <= kFarthest && max(votes.x, max(votes.y, votes.z)) < kEnough; stride *= 2) {
    for (int y = -reach; y <= reach; ++y) {
      for (int x = -1; x <= 1; ++x) {
        ivec2 at = clamp(cell + stride * ivec2(x, y), ivec2(0), size - 1);
        float there = floor(255.0 * texelFetch(carried, at, 0).r + 0.5);
        if (there == 0.0) continue;
        float away = apart(texelFetch(picture, at, 0).rgb, now) / kAlike;
        votes += vec3(equal(vec3(there), vec3(1.0, 2.0, 3.0))) / (1.0 + away * away);
      }
    }
  }
  float most = max(votes.x, max(votes.y, votes.z));
  float number = part.r;
  if (most > 0.0) number = votes.x == most ? part.g : votes.y == most ? part.b : part.a;
  imageStore(shares, cell, vec4(equal(vec3(number), vec3(1.0, 2.0, 3.0)), 0.0));
}
