// Purpose: whether movers are near a place.
// Inputs:  moverAt() before it (mover_labels.glsl or mover_places.glsl); places in px of the full
//          image.
// Outputs: functions.
// Precision: highp.

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
