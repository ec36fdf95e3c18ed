// Purpose: toon shading of a surface that is not there where its coverage is low.
// Inputs:  model_toon.glsl's; coverageCutoff, below which nothing is.
// Outputs: model_toon.glsl's. Precision: as there.
#include "pipeline/scene/shaders/model_toon.glsl"

uniform float coverageCutoff;

void main() {
  vec4 surface = surfaceColour();
  if (surface.a < coverageCutoff) discard;
  shade(surface.rgb);
}
