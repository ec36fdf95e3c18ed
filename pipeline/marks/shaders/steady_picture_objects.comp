// Purpose: the picture averaged over time, where objects are seen, too: a program of its own, because software
//          renderers pay for both sides of a branch.
// Inputs, outputs: as steady_picture.glsl's.
// Precision: highp.
const bool kHasObjects = true;
#include "pipeline/marks/shaders/steady_picture.glsl"
