// Purpose: what the passes of marks::MotionLayers share: where a place of the background was in the
//          previous frame, and by how much a colour is outside of a range.
// Defines: AT_REST: all of the background is where it was, and no model is known.
// Inputs:  image_motion.glsl's, of which only the homography is used; fullSize; isStanding: whether
//          the homography is the identity; ids if hasObjects, surfaceMotion (ArFrame::motion) if
//          hasSurfaces, and their pixelsOfFull.
// Outputs: displacements in px of the full image.
// Precision: highp.
#include "pipeline/marks/shaders/colour_difference.glsl"
#include "pipeline/marks/shaders/image_motion.glsl"
#include "pipeline/marks/movers/shaders/layer_cells.glsl"
#include "pipeline/scene/render/shaders/object_id.glsl"
const float kMatureSeconds = 0.2;  // seen to move for so long: a mover, also if it rests
const float kLikeMover = 0.5;  // of its difference from the background, a colour is the mover's
uniform vec2 fullSize;
uniform bool isStanding;
uniform bool hasObjects;
uniform bool hasSurfaces;
uniform highp sampler2D surfaceMotion;
uniform highp usampler2D ids;
uniform vec2 pixelsOfFull;

#ifdef AT_REST
vec2 pictureShift(vec2 px) { return vec2(0.0); }
vec2 backgroundShift(vec2 px) { return vec2(0.0); }
uint objectAt(vec2 px) { return 0u; }
#else
// The displacement of most of the image since the previous frame, from there to px.
vec2 pictureShift(vec2 px) { return isStanding ? vec2(0.0) : -byPicture(px, true).displacement; }

uint objectAt(vec2 px) {
  if (!hasObjects) return 0u;
  ivec2 pixel = clamp(ivec2(px * pixelsOfFull), ivec2(0), textureSize(ids, 0) - 1);
  return objectOf(texelFetch(ids, pixel, 0).r);
}

// The displacement of the background since the previous frame, from there to px. Planes, and real
// things whose models are known, go with their poses where the image's homography contradicts
// those, and where they are the more certain.
vec2 backgroundShift(vec2 px) {
  vec2 shift = pictureShift(px);
  if (!hasSurfaces || isVirtual(objectAt(px))) return shift;
  ivec2 last = textureSize(surfaceMotion, 0) - 1;
  vec4 surface = texelFetch(surfaceMotion, clamp(ivec2(px * pixelsOfFull), ivec2(0), last), 0);
  if (surface.w == 0.0) return shift;
  vec2 moved = surface.xy / pixelsOfFull;
  float error = surface.z / pixelsOfFull.x;
  float pictureError = known.z == 0.0 ? kUnknownError : known.w;
  return error < pictureError || distance(moved, shift) > 2.5 * error ? moved : shift;
}
#endif

// What a texture of cells had at a place of the previous frame.
vec4 pastAt(highp sampler2D cells, vec2 px) {
#ifdef AT_REST
  return texelFetch(cells, ivec2(px / kLayerCellPixels), 0);
#else
  return textureLod(cells, inLayers(cells, px), 0.0);
#endif
}

bool isInPicture(vec2 px) {
  return all(greaterThanEqual(px, vec2(0.0))) && all(lessThan(px, fullSize));
}

// By how much a colour is outside of a range.
float beyond(vec3 colour, vec3 low, vec3 high) {
  return weightedLength(max(max(low - colour, colour - high), 0.0));
}
