// Purpose: a surface that is not there where its coverage is low.
// Inputs:  model_surface.glsl's; coverageCutoff, below which nothing is.
// Outputs: model_surface.glsl's. Precision: as there.
#include "pipeline/scene/shaders/model_surface.glsl"

uniform float coverageCutoff;

void main() {
  vec4 surface = surfaceColour();
  if (surface.a < coverageCutoff) discard;
  writeSurface(surface.rgb);
}
