// Purpose: the motion of the mover at a place, from the edges around it.
// Inputs:  moverMotion (mover_motion.comp); layer_cells.glsl and layer_blocks.glsl before it.
// Outputs: displacement in a frame, less the background's, px of the full image.
// Precision: highp.
uniform highp sampler2D moverMotion;

// False if no mover near has edges.
bool findMoverMotion(vec2 px, out vec2 displacement) {
  vec2 at = px / (kLayerCellPixels * float(kLayerBlock)) - 0.5;
  ivec2 nearest = ivec2(floor(at + 0.5));
  ivec2 last = textureSize(moverMotion, 0) - 1;
  vec3 sum = vec3(0.0);
  for (int y = -2; y <= 2; ++y) {
    for (int x = -2; x <= 2; ++x) {
      ivec2 block = nearest + ivec2(x, y);
      if (any(lessThan(block, ivec2(0))) || any(greaterThan(block, last))) continue;
      vec2 away = vec2(block) - at;
      sum += exp(-0.7 * dot(away, away)) * texelFetch(moverMotion, block, 0).xyz;
    }
  }
  displacement = sum.xy / max(sum.z, 1e-6);
  return sum.z > 1e-3;
}
