// Purpose: projects a model's posed vertices through the camera, with lens distortion. Image rows grow
//          with y, so row 0 of the target is the image's top.
// Inputs:  position in the model's frame, octahedral normal (posing.glsl's output); texture
//          coordinate, linear colour; cameraFromModel and the matrix for normals (of any length);
//          pinhole terms in clip space.
// Outputs: normal and direction to the viewer in the camera's frame, texture coordinate, colour, the
//          triangle's number.
// Precision: highp, for the same reason as in lens.glsl.
#include "pipeline/scene/render/shaders/lens.glsl"
#include "pipeline/scene/render/shaders/octahedral.glsl"

uniform mat4 cameraFromModel;
uniform mat3 cameraFromModelNormals;
uniform vec2 clipFocal;   // 2 f / size
uniform vec2 clipCentre;  // 2 c / size - 1
uniform vec2 clipDepth;   // clip z = x * camera z + y

layout(location = 0) in vec3 position;
layout(location = 1) in uint normal;
layout(location = 2) in vec2 place;
layout(location = 3) in vec4 colour;

out vec3 cameraNormal;
out vec3 towardViewer;  // of any length
out vec2 texturePlace;
out vec4 vertexColour;
flat out uint triangle;

void main() {
  vec3 at = (cameraFromModel * vec4(position, 1.0)).xyz;
  vec3 p = throughLens(at);
  gl_Position = vec4(clipFocal * p.xy + clipCentre * p.z, clipDepth.x * p.z + clipDepth.y, p.z);
  vec3 turned = cameraFromModelNormals * fromOctahedral(normal);
  cameraNormal = turned / max(length(turned), 1e-12);
  towardViewer = -at;
  texturePlace = place;
  vertexColour = colour;
  triangle = uint(gl_VertexID);  // of the last corner: scene::DrawnModel
}
