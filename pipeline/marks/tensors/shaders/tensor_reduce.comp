// Purpose: the next level of the tensor pyramid: low-pass (Gaussian), then every second region
//          (thesis §4.2, step 3). The filter has an even width and is centred between the four
//          regions that one region of this level covers; centred on one of them, each level would
//          be off by half a region.
// Inputs:  filled (tensor_fill.comp).
// Outputs: reduced RGBA16F of half the size, same layout. One invocation per region.
// Precision: highp.
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba16f, binding = 0) writeonly uniform highp image2D reduced;
uniform highp sampler2D filled;

void main() {
  ivec2 region = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(region, imageSize(reduced)))) return;
  ivec2 last = textureSize(filled, 0) - 1;
  const float kernel[4] = float[4](1.0, 3.0, 3.0, 1.0);
  vec2 sum = vec2(0.0);
  float known = 0.0;
  float detail = 0.0;
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) {
      float weight = kernel[x] * kernel[y] / 64.0;
      vec4 there = texelFetch(filled, clamp(2 * region + ivec2(x, y) - 1, ivec2(0), last), 0);
      sum += weight * there.z * there.xy;
      known += weight * there.z;
      detail += weight * there.w;
    }
  }
  vec2 tensor = known > 1e-4 ? sum / known : vec2(0.0);
  imageStore(reduced, region, vec4(tensor, smoothstep(0.0, 0.1, known), detail));
}
