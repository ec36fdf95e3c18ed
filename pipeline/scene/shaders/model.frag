// Purpose: a solid surface in its light.
// Inputs:  model_surface.glsl's.
// Outputs: model_surface.glsl's. Precision: as there.
#include "pipeline/scene/shaders/model_surface.glsl"

void main() {
  writeSurface(surfaceColour().rgb);
}
