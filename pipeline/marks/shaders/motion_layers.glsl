// Purpose: what the passes of marks::MotionLayers share: where a place of the background was in the
//          previous frame, and the difference of colours.
// Inputs:  image_motion.glsl's, of which only the homography is used; fullSize; isStanding: whether
//          the homography is the identity.
// Outputs: places in texture coordinates. A cell is 2x2 px of the full image.
// Precision: highp.
#include "pipeline/marks/shaders/image_motion.glsl"
uniform vec2 fullSize;
uniform bool isStanding;

const float kCellPixels = 2.0;

// The displacement of the background since the previous frame, from there to px.
vec2 backgroundShift(vec2 px) { return isStanding ? vec2(0.0) : -byPicture(px, true).displacement; }

// Texture coordinates of a place in the textures of cells, which may reach beyond the image.
vec2 inCells(vec2 px, ivec2 cells) { return px / (kCellPixels * vec2(cells)); }

bool isInPicture(vec2 px) {
  return all(greaterThanEqual(px, vec2(0.0))) && all(lessThan(px, fullSize));
}

// As stroke_trace.comp's: roughly perceptual.
float apart(vec3 difference) { return sqrt(dot(difference * difference, vec3(0.9, 1.5, 0.6))); }

// By how much a colour is outside of a range.
float beyond(vec3 colour, vec3 low, vec3 high) {
  return apart(max(max(low - colour, colour - high), 0.0));
}
