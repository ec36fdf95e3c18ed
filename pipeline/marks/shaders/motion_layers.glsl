// Purpose: what the passes of marks::MotionLayers share: where a place of the background was in the
//          previous frame, and by how much a colour is outside of a range.
// Inputs:  image_motion.glsl's, of which only the homography is used; fullSize; isStanding: whether
//          the homography is the identity.
// Outputs: displacements in px of the full image.
// Precision: highp.
#include "pipeline/marks/shaders/colour_difference.glsl"
#include "pipeline/marks/shaders/image_motion.glsl"
#include "pipeline/marks/shaders/layer_cells.glsl"
const float kMatureSeconds = 0.2;  // seen to move for so long: a mover, also if it rests
const float kLikeMover = 0.5;  // of its difference from the background, a colour is the mover's
uniform vec2 fullSize;
uniform bool isStanding;

// The displacement of the background since the previous frame, from there to px.
vec2 backgroundShift(vec2 px) { return isStanding ? vec2(0.0) : -byPicture(px, true).displacement; }

bool isInPicture(vec2 px) {
  return all(greaterThanEqual(px, vec2(0.0))) && all(lessThan(px, fullSize));
}

// By how much a colour is outside of a range.
float beyond(vec3 colour, vec3 low, vec3 high) {
  return weightedLength(max(max(low - colour, colour - high), 0.0));
}
