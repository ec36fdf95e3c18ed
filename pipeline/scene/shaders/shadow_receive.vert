// Purpose: the square of a plane that a shadow's map covers, as the camera sees it, in small cells
//          because a lens bends lines.
// Inputs:  the vertex number; square: its centre and half its side in the attach frame; cells a
//          side; cameraFromAttach; lens.glsl's; pinhole terms in clip space.
// Outputs: the place on the map, 0 … 1.
// Precision: highp, for lens.glsl's reasons.
#include "pipeline/scene/shaders/lens.glsl"

uniform mat4 cameraFromAttach;
uniform vec3 square;
uniform int cells;
uniform vec2 clipFocal;   // 2 f / size
uniform vec2 clipCentre;  // 2 c / size - 1

out vec2 mapPlace;

const int kCorners[6] = int[6](0, 1, 2, 2, 1, 3);  // of two triangles

void main() {
  int cell = gl_VertexID / 6;
  int corner = kCorners[gl_VertexID % 6];
  ivec2 at = ivec2(cell % cells, cell / cells) + ivec2(corner & 1, corner >> 1);
  mapPlace = vec2(at) / float(cells);
  vec2 onPlane = square.xy + square.z * (2.0 * mapPlace - 1.0);
  vec3 p = throughLens((cameraFromAttach * vec4(onPlane, 0.0, 1.0)).xyz);
  gl_Position = vec4(clipFocal * p.xy + clipCentre * p.z, 0.0, p.z);
}
