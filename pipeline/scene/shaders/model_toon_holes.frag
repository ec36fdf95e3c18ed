// Purpose: toon shading of a surface that is not there where its coverage is low.
// Inputs:  model_toon.glsl's; coverageCutoff.
// Outputs, precision: model_toon.glsl's.
#include "pipeline/scene/shaders/model_toon.glsl"

uniform float coverageCutoff;

void main() {
  vec4 surface = surfaceColour();
  if (surface.a < coverageCutoff) discard;
  shade(surface.rgb);
}
