// Purpose: a solid surface, shaded in toon bands.
// Inputs:  model_surface.glsl's, shading_toon.glsl's.
// Outputs: model_surface.glsl's. Precision: as there.
#include "pipeline/scene/render/shaders/model_surface.glsl"
#include "pipeline/scene/render/shaders/shading_toon.glsl"

void main() {
  writeSurface(surfaceColour().rgb);
}
