// Purpose: the sums per cell from which its two washes, a dark and a light one, are computed:
//          moments of luma, and colour against luma. One invocation does a block of 4x4 pixels of
//          the guide and adds once per cell in the block.
// Inputs:  guide (guide.frag), tiling (tiling_word.glsl, twice the guide's size).
// Outputs: moments: per cell 8 words: R, G, B, count, L R, L G, L B, L³ / 8192; of 8-bit values,
//          with the luma L = 2 R + 5 G + B, whose mean is exactly that of the mean colour.
// Precision: integers, so that order does not matter; up to 4096 pixels per cell.
#include "pipeline/styles/watercolor/shaders/tiling_word.glsl"
layout(local_size_x = 16, local_size_y = 4) in;
layout(std430, binding = 0) buffer Moments { uint moments[]; };
uniform sampler2D guide;
uniform highp usampler2D tiling;

const int kPixels = 16;

void main() {
  ivec2 size = textureSize(guide, 0);
  ivec2 last = textureSize(tiling, 0) - 1;
  ivec2 corner = ivec2(gl_GlobalInvocationID.xy) * 4;
  if (any(greaterThanEqual(corner, size))) return;

  uint cell[kPixels];  // as in a tiling word, plus one; 0 beyond the border
  uvec4 first[kPixels];
  uvec4 second[kPixels];
  for (int i = 0; i < kPixels; ++i) {
    ivec2 p = corner + ivec2(i & 3, i >> 2);
    bool inside = all(lessThan(p, size));
    uint word = texelFetch(tiling, min(2 * p + 1, last), 0).r;
    cell[i] = inside ? slotOf(word) + 1u : 0u;
    uvec3 c = uvec3(texelFetch(guide, min(p, size - 1), 0).rgb * 255.0 + 0.5);
    uint luma = 2u * c.r + 5u * c.g + c.b;
    first[i] = uvec4(c, 1u);
    second[i] = uvec4(c * luma, (((luma * luma) >> 2u) * luma + 1024u) >> 11u);
  }

  for (uint above = 0xFFFFFFFFu;;) {
    uint name = 0u;
    for (int i = 0; i < kPixels; ++i) name = max(name, cell[i] < above ? cell[i] : 0u);
    if (name == 0u) break;
    uvec4 a = uvec4(0u);
    uvec4 b = uvec4(0u);
    for (int i = 0; i < kPixels; ++i) {
      uint taken = cell[i] == name ? 0xFFFFFFFFu : 0u;
      a += first[i] & taken;
      b += second[i] & taken;
    }
    uint base = (name - 1u) * 8u;
    for (uint k = 0u; k < 4u; ++k) {
      atomicAdd(moments[base + k], a[k]);
      atomicAdd(moments[base + 4u + k], b[k]);
    }
    above = name;
  }
}
