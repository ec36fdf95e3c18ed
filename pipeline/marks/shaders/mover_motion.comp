// Purpose: the motion of movers, in blocks of cells: where a mover has texture, dense flow is right;
//          its plain parts go with those around (mover_motion.glsl).
// Inputs:  labels, picture: this frame's, in cells; motion_layers.glsl's, flow backward.
// Outputs: moverMotion RGBA16F: displacement since the previous frame, less the background's (px of
//          the full image), times weight, and the weight. One invocation per block of kLayerBlock²
//          cells.
// Precision: highp.
#include "pipeline/gpu/shaders/luma.glsl"
#include "pipeline/marks/shaders/layer_blocks.glsl"
#include "pipeline/marks/shaders/motion_layers.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba16f, binding = 0) writeonly uniform highp image2D moverMotion;
uniform highp sampler2D labels;
uniform highp sampler2D picture;

const int kStep = 2;  // cells
const float kMaxError = 3.0;  // px
const vec2 kTexture = vec2(0.03, 0.1);  // luma: from no texture to enough of it

void main() {
  ivec2 block = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(block, imageSize(moverMotion)))) return;
  ivec2 first = block * kLayerBlock;
  ivec2 size = textureSize(labels, 0);
  vec3 sum = vec3(0.0);
  for (int y = 0; y < kLayerBlock; y += kStep) {
    for (int x = 0; x < kLayerBlock; x += kStep) {
      ivec2 cell = first + ivec2(x, y);
      if (any(greaterThanEqual(cell, size))) continue;
      if (texelFetch(labels, cell, 0).r < 0.5) continue;
      float low = 1.0;
      float high = 0.0;
      for (int i = 0; i < 4; ++i) {
        ivec2 at = clamp(cell + 2 * ivec2(i & 1, i >> 1) - 1, ivec2(0), size - 1);
        float luma = lumaOf(texelFetch(picture, at, 0).rgb);
        low = min(low, luma);
        high = max(high, luma);
      }
      float weight = smoothstep(kTexture.x, kTexture.y, high - low);
      if (weight <= 0.0) continue;
      vec2 px = (vec2(cell) + 0.5) * kLayerCellPixels;
      Moved flowed = byFlow(px);
      if (flowed.error > kMaxError) continue;
      vec2 displacement = -flowed.displacement - backgroundShift(px);
      sum += weight / (0.25 + flowed.error * flowed.error) * vec3(displacement, 1.0);
    }
  }
  imageStore(moverMotion, block, vec4(sum, 0.0));
}
