// Purpose: a surface that is not there where its coverage is low, shaded smoothly.
// Inputs:  model_surface.glsl's, shading_smooth.glsl's; coverageCutoff, below which nothing is.
// Outputs: model_surface.glsl's. Precision: as there.
#include "pipeline/scene/render/shaders/model_surface.glsl"
#include "pipeline/scene/render/shaders/shading_smooth.glsl"

uniform float coverageCutoff;

void main() {
  vec4 surface = surfaceColour();
  if (surface.a < coverageCutoff) discard;
  writeSurface(surface.rgb);
}
