// Purpose: an alpha-masked surface, shaded in toon bands.
// Inputs:  those of model_surface.glsl and shading_toon.glsl; coverageCutoff, below which nothing is
//          drawn.
// Outputs: those of model_surface.glsl. Precision: as there.
#include "pipeline/scene/render/shaders/model_surface.glsl"
#include "pipeline/scene/render/shaders/shading_toon.glsl"

uniform float coverageCutoff;

void main() {
  vec4 surface = surfaceColour();
  if (surface.a < coverageCutoff) discard;
  writeSurface(surface.rgb);
}
