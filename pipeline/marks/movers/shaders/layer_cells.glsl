// Purpose: places in the textures of marks::MotionLayers.
// Inputs:  places in px of the full image.
// Outputs: places in texture coordinates.
// Precision: highp.
const float kLayerCellPixels = 2.0;  // side of a texel: marks::MotionLayers::kCellPixels

// The textures may reach beyond the image.
vec2 inLayers(highp sampler2D layers, vec2 px) {
  return px / (kLayerCellPixels * vec2(textureSize(layers, 0)));
}
