// Purpose: surface data of the pixels of an occluder, whose motion has the error of its pose.
// Inputs, outputs, precision: as in surface.glsl.
#include "pipeline/scene/render/shaders/surface.glsl"

float errorAt(vec3 current) { return predictedError(body, current); }
