// Purpose: an alpha-masked surface, shaded smoothly.
// Inputs:  those of model_surface.glsl and shading_smooth.glsl; coverageCutoff, below which nothing is
//          drawn.
// Outputs: those of model_surface.glsl. Precision: as there.
#include "pipeline/scene/render/shaders/model_surface.glsl"
#include "pipeline/scene/render/shaders/shading_smooth.glsl"

uniform float coverageCutoff;

void main() {
  vec4 surface = surfaceColour();
  if (surface.a < coverageCutoff) discard;
  writeSurface(surface.rgb);
}
