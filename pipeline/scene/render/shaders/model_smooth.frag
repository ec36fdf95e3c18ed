// Purpose: an opaque surface, shaded smoothly.
// Inputs:  those of model_surface.glsl and shading_smooth.glsl.
// Outputs: those of model_surface.glsl. Precision: as there.
#include "pipeline/scene/render/shaders/model_surface.glsl"
#include "pipeline/scene/render/shaders/shading_smooth.glsl"

void main() {
  writeSurface(surfaceColour().rgb);
}
