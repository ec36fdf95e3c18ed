// Purpose: a solid surface, shaded smoothly.
// Inputs:  model_surface.glsl's, shading_smooth.glsl's.
// Outputs: model_surface.glsl's. Precision: as there.
#include "pipeline/scene/render/shaders/model_surface.glsl"
#include "pipeline/scene/render/shaders/shading_smooth.glsl"

void main() {
  writeSurface(surfaceColour().rgb);
}
