// Purpose: how dynamic a place of the background is, as leaves in the wind, water and screens are.
//          What differs there by little more than it always does is no mover, and changes no strokes
//          (local thresholds: St-Charles, Bilodeau, Bergevin, "SuBSENSE", 2015).
// Inputs:  backgroundActivity: R: the running mean of how unlike its mean colour each cell of the
//          background is, beyond noise, counted up to kMostUnlike (weightedLength() of sRGB-coded
//          colours in [0, 1]); 0 where it was never seen. It is learned before a camera that stands,
//          and fades while the camera moves.
// Outputs: functions of it.
// Precision: highp.
#include "pipeline/marks/movers/shaders/layer_cells.glsl"
uniform highp sampler2D backgroundActivity;

const float kActivitySeconds = 1.0;       // time constant
const float kMoverActivitySeconds = 3.0;  // – where a mover has been seen to move
const float kMostShare = 0.1;         // of one frame in the mean, however long it took
const float kMostUnlike = 0.1;        // what covers a place for a moment tells little of it, …
const float kMostUnlikeMover = 0.05;  // … and a mover that stays less
const float kNoiseMean = 1.5;  // sigmas of a cell by which noise alone makes it differ
const float kQuiet = 0.005;  // an activity that changes nothing
const float kActivityDeviations = 2.0;  // of it, a mover must differ by so much more

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
  return mix(before, unlike, min(1.0 - exp(-stepSeconds / seconds), kMostShare));
}
