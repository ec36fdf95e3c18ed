// Purpose: what is known about the pixels of a model.
// Defines: REAL: of a real thing's shape (an occluder), which is where its pose says only as well as
//          that is known; without, of a virtual model, whose motion is exact.
// Inputs, outputs, precision: surface.glsl's.
#include "pipeline/scene/render/shaders/surface.glsl"

#ifdef REAL
float errorAt(vec3 now) { return predictedError(body, now); }
#else
float errorAt(vec3 now) { return 0.0; }
#endif
