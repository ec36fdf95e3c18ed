// Purpose: projects parts of a machine at rest, or on their way to another place.
// Inputs:  position in the model's frame, normal, travel (xyz: the other place relative to the part's own,
//          w: 0 leaves, 1 comes home, 2 stays there); cameraFromModel; pinhole terms in clip space; phase of the
//          movement, 0 … 1.
// Outputs: normal in the camera's frame.
// Precision: highp, for the same reason as in lens.glsl.
#include "pipeline/scene/render/shaders/lens.glsl"

uniform mat4 cameraFromModel;
uniform vec2 clipFocal;   // 2 f / size
uniform vec2 clipCentre;  // 2 c / size - 1
uniform vec2 clipDepth;   // clip z = x * camera z + y
uniform float phase;

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 travel;

out vec3 cameraNormal;

void main() {
  float away = travel.w > 1.5 ? 1.0 : travel.w > 0.5 ? 1.0 - phase : phase;
  vec3 p = throughLens((cameraFromModel * vec4(position + away * travel.xyz, 1.0)).xyz);
  gl_Position = vec4(clipFocal * p.xy + clipCentre * p.z, clipDepth.x * p.z + clipDepth.y, p.z);
  cameraNormal = mat3(cameraFromModel) * normal;
}
