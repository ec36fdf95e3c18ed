// Purpose: surface data of the pixels of a virtual model, whose motion is exact.
// Inputs, outputs, precision: as in surface.glsl.
#include "pipeline/scene/render/shaders/surface.glsl"

float errorAt(vec3 current) { return 0.0; }
