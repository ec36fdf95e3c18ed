// Purpose: what of the image belongs to movers (marks::MotionLayers::labels).
// Inputs:  movers; places in px of the full image.
// Outputs: mover: in [0, 1]; freshness: 1 where that has just changed.
// Precision: highp.
uniform highp sampler2D movers;

const float kMoverPixels = 2.0;  // of a texel: marks::MotionLayers::kCellPixels

// Texture coordinates in the textures of marks::MotionLayers; they may reach beyond the image.
vec2 inLayers(highp sampler2D layers, vec2 px) {
  return px / (kMoverPixels * vec2(textureSize(layers, 0)));
}

vec2 moverAt(vec2 px) { return textureLod(movers, inLayers(movers, px), 0.0).rg; }

// Whether a mover is so near that the measured motion may be its own.
bool isNearMover(vec2 px) {
  const float kNear = 14.0;
  float most = moverAt(px).r;
  for (int i = 0; i < 4; ++i) {
    float along = i < 2 ? -kNear : kNear;
    most = max(most, moverAt(px + vec2(i % 2 == 0 ? along : 0.0, i % 2 == 0 ? 0.0 : along)).r);
  }
  return most > 0.25;
}
