// Purpose: toon shading of a solid surface.
// Inputs, outputs, precision: model_toon.glsl's.
#include "pipeline/scene/shaders/model_toon.glsl"

void main() {
  shade(surfaceColour().rgb);
}
