// Purpose: poses a model's vertices: morph targets, then joints (linear blend skinning; glTF 2.0,
//          section 3.7.3.3). A rigid part has one joint.
// Inputs:  storage 0: vertices at rest (scene::RestVertex); 1: matrices of all models, three rows
//          each, followed by their weights; firstMatrix: of this object.
// Outputs: storage 2: position in the model's frame, octahedral normal; 16 bytes per vertex.
// Precision: highp; weights have 16 bits and are normalised to sum to 1.
#include "pipeline/scene/render/shaders/octahedral.glsl"

layout(local_size_x = 64) in;

struct RestVertex {
  vec3 position;
  uint firstMatrix;
  uint normal;
  uint joints;
  uvec2 weights;
};
struct PosedVertex {
  vec3 position;
  uint normal;
};
layout(std430, binding = 0) readonly buffer Rest { RestVertex rest[]; };
layout(std430, binding = 1) readonly buffer Matrices { vec4 matrixRows[]; };
// volatile: docs/gpu.md, rule 22
layout(std430, binding = 2) volatile writeonly buffer Posed { PosedVertex posed[]; };

uniform uint firstRest;  // of this range, in rest
uniform uint firstPosed;  // of this range, in posed
uniform uint vertexCount;
uniform uint firstVertex;  // of this dispatch, from the range's start
uniform uint firstMatrix;

struct Transform {
  vec4 x;
  vec4 y;
  vec4 z;
};

Transform matrixAt(uint index) {
  uint row = 3u * index;
  return Transform(matrixRows[row], matrixRows[row + 1u], matrixRows[row + 2u]);
}

Transform heldBy(RestVertex v) {
  uint first = firstMatrix + v.firstMatrix;
  if (v.weights == uvec2(0xffffu, 0u)) return matrixAt(first + (v.joints & 255u));
  vec4 w = vec4(unpackUnorm2x16(v.weights.x), unpackUnorm2x16(v.weights.y));
  w /= max(w.x + w.y + w.z + w.w, 1e-6);
  Transform sum = Transform(vec4(0.0), vec4(0.0), vec4(0.0));
  for (int i = 0; i < 4; ++i) {
    if (w[i] == 0.0) continue;
    Transform t = matrixAt(first + (v.joints >> (8 * i) & 255u));
    sum.x += w[i] * t.x;
    sum.y += w[i] * t.y;
    sum.z += w[i] * t.z;
  }
  return sum;
}

// Normals transform by the cofactors, which exist for mirrored and flattened parts too.
vec3 turnedNormal(Transform t, vec3 n) {
  vec3 cx = cross(t.y.xyz, t.z.xyz);
  vec3 cy = cross(t.z.xyz, t.x.xyz);
  vec3 cz = cross(t.x.xyz, t.y.xyz);
  vec3 turned = vec3(dot(cx, n), dot(cy, n), dot(cz, n));
  if (dot(t.x.xyz, cx) < 0.0) turned = -turned;
  // Scaled first, since its square may underflow.
  float size = max(max(abs(turned.x), abs(turned.y)), abs(turned.z));
  return size > 0.0 ? normalize(turned / size) : vec3(0.0, 0.0, 1.0);
}

void pose(uint i, vec3 position, vec3 normal) {
  Transform t = heldBy(rest[firstRest + i]);
  vec4 p = vec4(position, 1.0);
  posed[firstPosed + i] = PosedVertex(vec3(dot(t.x, p), dot(t.y, p), dot(t.z, p)),
                                      toOctahedral(turnedNormal(t, normal)));
}
