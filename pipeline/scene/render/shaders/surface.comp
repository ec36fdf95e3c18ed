// Purpose: what is known about the pixels of a virtual model, whose motion is exact.
// Inputs, outputs, precision: surface.glsl's.
#include "pipeline/scene/render/shaders/surface.glsl"

float errorAt(vec3 now) { return 0.0; }
