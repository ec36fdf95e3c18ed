// Purpose: how clearly something narrow is seen at a place, which a stroke paints over the others of
//          its layer: both sides have another colour, in the same way; at an edge, one has not, or the
//          place has a colour between those of both.
// Inputs:  the differences of the sides' colours from the place's, sRGB-coded.
// Outputs: a weighted length, as colour_difference.glsl's: the geometric mean of both.
// Precision: that of the colours.
#include "pipeline/marks/shaders/colour_difference.glsl"
const float kNewAccent = 0.11;  // from which a new stroke is an accent, and anchors are born
// For a stroke that exists to become one, and to remain one. Far apart: each change of the painting
// order is seen.
const float kLaterAccent = 0.3;
const float kRemainingAccent = 0.015;

float narrowness(vec3 left, vec3 right) {
  return sqrt(max(dot(left * right, kColourWeights), 0.0));
}
