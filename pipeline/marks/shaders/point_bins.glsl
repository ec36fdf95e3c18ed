// Purpose: points sorted into bins (marks/point_bins.h).
// Inputs:  bins: columns and rows; binPixels: a bin's sides.
// Outputs: ivec4 points: x, y in 1/64 px, penalty in 1/4096 px², slot (below 0: none).
// Precision: integers are exact.
uniform ivec2 bins;
uniform vec2 binPixels;
const float kPointUnits = 64.0;

// The bin of a place; the nearest one for a place outside the image.
ivec2 binOf(vec2 pixel) { return clamp(ivec2(floor(pixel / binPixels)), ivec2(0), bins - 1); }
