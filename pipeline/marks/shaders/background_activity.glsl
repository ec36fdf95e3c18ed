// Purpose: how dynamic a place of the background is, as leaves in the wind, water and screens are.
//          What differs there by no more than it always does is no mover, and changes no strokes
//          (local thresholds: St-Charles, Bilodeau, Bergevin, "SuBSENSE", 2015).
// Inputs:  backgroundActivity: R: the running mean of how unlike its mean colour each cell of the background
//          is (weightedLength()); it is learned before a camera that stands.
// Outputs: functions of it.
// Precision: highp.
#include "pipeline/marks/shaders/layer_cells.glsl"
uniform highp sampler2D backgroundActivity;

const float kActivitySeconds = 1.0;       // within which it is learned
const float kMoverActivitySeconds = 3.0;  // – where a mover has been seen to move
const float kMostUnlike = 0.1;  // counts: what covers a place for a moment tells little of it
const float kQuiet = 0.01;      // noise alone reads less
const float kActivityDeviations = 2.0;

float activityAt(vec2 px) {
  ivec2 last = textureSize(backgroundActivity, 0) - 1;
  ivec2 cell = clamp(ivec2(px / kLayerCellPixels), ivec2(0), last);
  return texelFetch(backgroundActivity, cell, 0).r;
}

// From 0, where the background is quiet, to 1.
float dynamicShare(float activity) {
  const float kDynamic = 0.02;  // beyond what is quiet
  return min(max(activity - kQuiet, 0.0) / kDynamic, 1.0);
}

// By how much more a colour must differ there.
float slackOf(float activity) { return kActivityDeviations * max(activity - kQuiet, 0.0); }

float activityAfter(float before, float unlike, float stepSeconds, float seconds) {
  return mix(before, min(unlike, kMostUnlike), min(stepSeconds / seconds, 1.0));
}
