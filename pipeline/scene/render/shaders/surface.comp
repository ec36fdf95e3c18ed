// Purpose: surface data of the pixels of a model.
// Defines: REAL: the model is an occluder, whose motion has the error of its pose; without it, a virtual
//          model, whose motion is exact.
// Inputs, outputs, precision: surface.glsl's.
#include "pipeline/scene/render/shaders/surface.glsl"

#ifdef REAL
float errorAt(vec3 now) { return predictedError(body, now); }
#else
float errorAt(vec3 now) { return 0.0; }
#endif
