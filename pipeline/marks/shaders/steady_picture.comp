// Purpose: the picture averaged over time, where only the camera's picture is seen.
// Inputs, outputs: as steady_picture.glsl's.
// Precision: highp.
const bool kHasObjects = false;
#include "pipeline/marks/shaders/steady_picture.glsl"
