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
  ivec2 first = max(nearest - 2, ivec2(0));
  last = min(nearest + 2, last);
  for (int y = first.y; y <= last.y; ++y) {
    for (int x = first.x; x <= last.x; ++x) {
      ivec2 block = ivec2(x, y);
      vec2 away = vec2(block) - at;
      sum += exp(-0.7 * dot(away, away)) * texelFetch(moverMotion, block, 0).xyz;
    }
  }
  displacement = sum.xy / max(sum.z, 1e-6);
  return sum.z > 1e-3;
}
