// Purpose: the bins that points are sorted into (marks/anchors/point_bins.h).
// Inputs:  bins: columns and rows; binPixels: a bin's sides; point.glsl's.
// Outputs: the bin of a place.
// Precision: integers are exact.
#include "pipeline/marks/anchors/shaders/point.glsl"
uniform ivec2 bins;
uniform vec2 binPixels;

// The bin of a place; the nearest one for a place outside the image.
ivec2 binOf(vec2 pixel) { return clamp(ivec2(floor(pixel / binPixels)), ivec2(0), bins - 1); }
