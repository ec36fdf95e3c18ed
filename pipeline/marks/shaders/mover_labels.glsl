// Purpose: what of the image belongs to movers (marks::MotionLayers::labels).
// Inputs:  movers; places in px of the full image.
// Outputs: mover: in [0, 1]; freshness: 1 where that has just changed.
// Precision: highp.
#include "pipeline/marks/shaders/layer_cells.glsl"
uniform highp sampler2D movers;

vec2 moverAt(vec2 px) { return textureLod(movers, inLayers(movers, px), 0.0).rg; }

// The largest label at a place and at this distance from it, in px.
float nearestMover(vec2 px, float reach) {
  float most = moverAt(px).r;
  for (int i = 0; i < 4; ++i) {
    float along = i < 2 ? -reach : reach;
    most = max(most, moverAt(px + vec2(i % 2 == 0 ? along : 0.0, i % 2 == 0 ? 0.0 : along)).r);
  }
  return most;
}

// Whether a mover is so near that the measured motion may be its own.
bool isNearMover(vec2 px) {
  const float kNear = 14.0;
  return nearestMover(px, kNear) > 0.25;
}
