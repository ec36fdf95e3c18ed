// Purpose: points that are sorted by bins (marks/point_bins.h).
// Inputs:  bins: columns and rows; binPixels: a bin's sides.
// Outputs: ivec4 points: x, y in 1/64 px, penalty in 1/4096 px², slot (below 0: there is none).
// Precision: integers are exact.
uniform ivec2 bins;
uniform vec2 binPixels;
const float kPointUnits = 64.0;

// The bin of a place; of one outside the picture the nearest.
ivec2 binOf(vec2 pixel) { return clamp(ivec2(floor(pixel / binPixels)), ivec2(0), bins - 1); }
