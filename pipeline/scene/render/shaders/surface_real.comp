// Purpose: what is known about the pixels of a real thing's shape (an occluder), which is where its
//          pose says only as well as that is known.
// Inputs, outputs, precision: surface.glsl's.
#include "pipeline/scene/render/shaders/surface.glsl"

float errorAt(vec3 now) { return predictedError(body, now); }
