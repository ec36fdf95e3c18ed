// Purpose: poses vertices.
// Defines: MORPHED: with morph targets.
// Inputs:  posing.glsl's; MORPHED: storage 3: the offset of each vertex by each target
//          (scene::MorphDelta), target by target; the place of this range's weights, after the
//          matrices.
// Outputs, precision: posing.glsl's. One vertex per invocation.
#include "pipeline/scene/render/shaders/posing.glsl"

#ifdef MORPHED
struct MorphDelta {
  vec4 position;
  vec4 normal;
};
layout(std430, binding = 3) readonly buffer Deltas { MorphDelta deltas[]; };

uniform uint targetCount;
uniform uint firstDelta;
uniform uint firstWeightRow;  // of matrixRows; four weights a row
uniform uint firstWeight;     // from there

float weightAt(uint target) {
  uint i = firstWeight + target;
  return matrixRows[firstWeightRow + i / 4u][int(i % 4u)];
}
#endif

void main() {
  uint i = firstVertex + gl_GlobalInvocationID.x;
  if (i >= vertexCount) return;
  RestVertex v = rest[firstRest + i];
#ifdef MORPHED
  vec3 position = v.position;
  vec3 normal = fromOctahedral(v.normal);
  for (uint target = 0u; target < targetCount; ++target) {
    float weight = weightAt(target);
    if (weight == 0.0) continue;
    MorphDelta delta = deltas[firstDelta + target * vertexCount + i];
    position += weight * delta.position.xyz;
    normal += weight * delta.normal.xyz;
  }
  float size = length(normal);
  pose(i, position, size > 0.0 ? normal / size : fromOctahedral(v.normal));
#else
  pose(i, v.position, fromOctahedral(v.normal));
#endif
}
