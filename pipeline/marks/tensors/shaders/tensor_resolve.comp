// Purpose: precomputes the look-up in the pyramid: a region without a direction takes that of the
//          level above, so that one read finds the finest direction (thesis §4.2).
// Inputs:  filled, of this level; above: the resolved level above it; isTop: there is none above.
// Outputs: resolved RGBA16F: tensor, confidence on this level, detail. One invocation per region.
// Precision: highp.
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba16f, binding = 0) writeonly uniform highp image2D resolved;
uniform highp sampler2D filled;
uniform highp sampler2D above;
uniform bool isTop;

void main() {
  ivec2 region = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(resolved);
  if (any(greaterThanEqual(region, size))) return;
  vec4 own = texelFetch(filled, region, 0);
  // No direction anywhere: strokes lie flat with a slight slope. The gradient's direction is
  // upright.
  vec2 upper = vec2(-0.94, -0.342);
  if (!isTop) upper = textureLod(above, (vec2(region) + 0.5) / (2.0 * vec2(textureSize(above, 0))), 0.0).xy;
  vec2 tensor = mix(upper, own.xy, own.z);
  // Tensors that cancel each other leave no direction; the level above has one.
  float agreement = length(tensor);
  tensor = mix(upper, tensor, smoothstep(0.02, 0.1, agreement));
  imageStore(resolved, region, vec4(tensor, own.z, own.w));
}
