// Purpose: points of the posed triangles of all models.
// Inputs:  storage 0: posed vertices; 1: triangles (scene::PosedGeometry).
// Outputs: positions in the model's frame, metres.
// Precision: highp.
struct PosedVertex {
  vec3 position;
  uint normal;
};
layout(std430, binding = 0) readonly buffer Posed { PosedVertex posed[]; };
layout(std430, binding = 1) readonly buffer Triangles { uvec4 triangles[]; };  // corners, part

struct SurfacePoint {
  uvec3 corners;  // of the object's vertices
  uint part;
  vec3 barycentrics;
};

// `firstVertex`: of the object, in this frame or the previous one (Body::places).
vec3 cornerOf(SurfacePoint point, int corner, uint firstVertex) {
  return posed[firstVertex + point.corners[corner]].position;
}

vec3 positionOf(SurfacePoint point, uint firstVertex) {
  vec3 at = vec3(0.0);
  for (int i = 0; i < 3; ++i) at += point.barycentrics[i] * cornerOf(point, i, firstVertex);
  return at;
}
