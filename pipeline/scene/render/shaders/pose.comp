// Purpose: poses vertices without morph targets.
// Inputs, outputs, precision: as in posing.glsl. One vertex per invocation.
#include "pipeline/scene/render/shaders/posing.glsl"

void main() {
  uint i = firstVertex + gl_GlobalInvocationID.x;
  if (i >= vertexCount) return;
  RestVertex v = rest[firstRest + i];
  pose(i, v.position, fromOctahedral(v.normal));
}
