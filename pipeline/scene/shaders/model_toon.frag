// Purpose: toon shading of a solid surface.
// Inputs:  model_toon.glsl's.
// Outputs: model_toon.glsl's. Precision: as there.
#include "pipeline/scene/shaders/model_toon.glsl"

void main() {
  shade(surfaceColour().rgb);
}
