// Purpose: the motion of a mover at a place, from blocks around it.
// Inputs:  moverMotion (mover_smooth.comp; its steps read that of mover_motion.comp); layer_cells.glsl and layer_blocks.glsl before it.
// Outputs: displacement in a frame, less the background's, px of the full image.
// Precision: highp.
uniform highp sampler2D moverMotion;

// Blocks of one mover: the movers' are one above the other.
ivec2 sizeOfMotion() {
  ivec2 size = textureSize(moverMotion, 0);
  return ivec2(size.x, max(size.y / 3, 1));
}

// False if the mover with this number, from 1 on, has shown nothing near.
bool findMoverMotion(vec2 px, int number, out vec2 displacement) {
  vec2 at = px / (kLayerCellPixels * float(kLayerBlock)) - 0.5;
  ivec2 nearest = ivec2(floor(at + 0.5));
  ivec2 size = sizeOfMotion();
  int row = min((number - 1) * size.y, textureSize(moverMotion, 0).y - size.y);
  vec3 sum = vec3(0.0);
  ivec2 first = max(nearest - 2, ivec2(0));
  ivec2 last = min(nearest + 2, size - 1);
  for (int y = first.y; y <= last.y; ++y) {
    for (int x = first.x; x <= last.x; ++x) {
      vec2 away = vec2(x, y) - at;
      sum += exp(-1.5 * dot(away, away)) * texelFetch(moverMotion, ivec2(x, row + y), 0).xyz;
    }
  }
  displacement = sum.xy / max(sum.z, 1e-6);
  return sum.z > 1e-3;
}
