// Purpose: the sums per cell from which its two washes, a dark and a light one, are computed:
//          moments of luma, and colour against luma. One invocation does a block of 4x4 pixels of
//          the guide and adds once per cell in the block.
// Inputs:  guide (guide.frag), tiling (tiling_word.glsl, twice the guide's size).
// Outputs: moments (moments.glsl).
// Precision: integers, so that order does not matter; up to 4096 pixels per cell.
#include "pipeline/gpu/images/shaders/pixel_block.glsl"
#include "pipeline/styles/watercolor/shaders/moments.glsl"
#include "pipeline/styles/watercolor/shaders/tiling_word.glsl"
layout(local_size_x = 16, local_size_y = 4) in;
layout(std430, binding = 0) buffer Moments { uint moments[]; };
uniform sampler2D guide;
uniform highp usampler2D tiling;

void main() {
  ivec2 size = textureSize(guide, 0);
  ivec2 last = textureSize(tiling, 0) - 1;
  ivec2 corner = ivec2(gl_GlobalInvocationID.xy) * kBlockSide;
  if (any(greaterThanEqual(corner, size))) return;

  uint cell[kBlockPixels];     // as in a tiling word, plus one; 0 beyond the border
  uint colours[kBlockPixels];  // packed: what the sums add up is made anew for each cell
  for (int i = 0; i < kBlockPixels; ++i) {
    ivec2 p = corner + inBlock(i);
    bool inside = all(lessThan(p, size));
    uint word = texelFetch(tiling, min(2 * p + 1, last), 0).r;
    cell[i] = inside ? slotOf(word) + 1u : 0u;
    uvec3 c = uvec3(texelFetch(guide, min(p, size - 1), 0).rgb * 255.0 + 0.5);
    colours[i] = c.r | (c.g << 8u) | (c.b << 16u);
  }

  for (uint above = 0xFFFFFFFFu;;) {
    uint name = 0u;
    for (int i = 0; i < kBlockPixels; ++i) name = max(name, cell[i] < above ? cell[i] : 0u);
    if (name == 0u) break;
    uvec4 a = uvec4(0u);
    uvec4 b = uvec4(0u);
    for (int i = 0; i < kBlockPixels; ++i) {
      uint taken = cell[i] == name ? 0xFFFFFFFFu : 0u;
      // Black counts nothing but itself.
      uint colour = colours[i] & taken;
      uvec3 c = uvec3(colour, colour >> 8u, colour >> 16u) & 0xFFu;
      uint luma = momentLuma(c);
      a += uvec4(c, taken & 1u);
      b += uvec4(c * luma, (((luma * luma) >> 2u) * luma + 1024u) >> 11u);
    }
    uint base = (name - 1u) * uint(kMomentWords);
    for (uint k = 0u; k < 4u; ++k) {
      atomicAdd(moments[base + k], a[k]);
      atomicAdd(moments[base + 4u + k], b[k]);
    }
    above = name;
  }
}
