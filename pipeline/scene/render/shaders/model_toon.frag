// Purpose: an opaque surface, shaded in toon bands.
// Inputs:  those of model_surface.glsl and shading_toon.glsl.
// Outputs: those of model_surface.glsl. Precision: as there.
#include "pipeline/scene/render/shaders/model_surface.glsl"
#include "pipeline/scene/render/shaders/shading_toon.glsl"

void main() {
  writeSurface(surfaceColour().rgb);
}
