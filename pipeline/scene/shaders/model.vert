// Purpose: a model's vertices through the camera, lens distortion included (Brown-Conrady with
//          OpenCV's rational terms, as tracking/camera_model.h has it). Image rows grow with y, so
//          row 0 of the target is the picture's top.
// Inputs:  position, normal in the part's frame, not indexed; cameraFromPart and what takes normals
//          (of any length) along; pinhole terms in clip space, distortion; place on the texture,
//          linear colour; the number of the surface's first triangle.
// Outputs: normal in the camera's frame, place, colour, the triangle's number.
// Precision: highp; a hundredth of a pixel at 1280 px needs 17 bits.
uniform mat4 cameraFromPart;
uniform mat3 cameraFromPartNormals;
uniform vec2 clipFocal;   // 2 f / size
uniform vec2 clipCentre;  // 2 c / size - 1
uniform vec2 clipDepth;   // clip z = x * camera z + y
uniform vec3 radial;      // k1 k2 k3
uniform vec2 tangential;  // p1 p2
uniform vec3 radialBelow; // k4 k5 k6
uniform float trustedRadius;
uniform int firstVertex;
uniform uint firstTriangle;

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 place;
layout(location = 3) in vec4 colour;

out vec3 cameraNormal;
out vec2 texturePlace;
out vec4 vertexColour;
flat out uint triangle;

// What the lens adds to a point of the plane z = 1. Outside the trusted radius: what it adds there.
vec2 lensShift(vec2 p) {
  p *= min(1.0, trustedRadius / max(length(p), 1e-9));
  float r2 = dot(p, p);
  float above = 1.0 + r2 * (radial.x + r2 * (radial.y + r2 * radial.z));
  float below = 1.0 + r2 * (radialBelow.x + r2 * (radialBelow.y + r2 * radialBelow.z));
  vec2 bent = vec2(2.0 * tangential.x * p.x * p.y + tangential.y * (r2 + 2.0 * p.x * p.x),
                   tangential.x * (r2 + 2.0 * p.y * p.y) + 2.0 * tangential.y * p.x * p.y);
  return p * (above / below - 1.0) + bent;
}

void main() {
  vec3 p = (cameraFromPart * vec4(position, 1.0)).xyz;
  // The shift is bounded, so that it fades to none towards z = 0, and stays none behind the camera.
  if (p.z > 0.0) p.xy += p.z * lensShift(p.xy / p.z);
  gl_Position = vec4(clipFocal * p.xy + clipCentre * p.z, clipDepth.x * p.z + clipDepth.y, p.z);
  vec3 turned = cameraFromPartNormals * normal;
  cameraNormal = turned / max(length(turned), 1e-12);
  texturePlace = place;
  vertexColour = colour;
  triangle = firstTriangle + uint((gl_VertexID - firstVertex) / 3);
}
