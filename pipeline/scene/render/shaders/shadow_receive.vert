// Purpose: the square of a plane that a shadow map covers, projected by the camera in small cells,
//          because a lens bends lines.
// Inputs:  the vertex number; square: its centre and half its side in the attach frame; cells per
//          side; map; cameraFromAttach; those of lens.glsl; pinhole terms in clip space.
// Outputs: the position on the map, 0 … 1; cells without shadow, which are most, are discarded.
// Precision: highp, for the same reason as in lens.glsl.
#include "pipeline/scene/render/shaders/lens.glsl"

uniform mat4 cameraFromAttach;
uniform vec3 square;
uniform int cells;
uniform highp sampler2D map;
uniform vec2 clipFocal;   // 2 f / size
uniform vec2 clipCentre;  // 2 c / size - 1

out vec2 mapPlace;

const int kCorners[6] = int[6](0, 1, 2, 2, 1, 3);  // of two triangles

// Whether any texel of a cell, or next to it within the filter's reach, is dark. Each tap lies
// between four texels.
bool holdsShadow(ivec2 cell) {
  vec2 texel = 1.0 / vec2(textureSize(map, 0));
  ivec2 texels = textureSize(map, 0) / cells;
  vec2 most = vec2(0.0);
  for (int y = -1; y <= texels.y; y += 2) {
    for (int x = -1; x <= texels.x; x += 2) {
      vec2 place = vec2(cell * texels + ivec2(x, y) + 1) * texel;
      most = max(most, textureLod(map, place, 0.0).rg);
    }
  }
  return most.x + most.y > 0.0;
}

void main() {
  int cell = gl_VertexID / 6;
  int corner = kCorners[gl_VertexID % 6];
  ivec2 place = ivec2(cell % cells, cell / cells);
  if (!holdsShadow(place)) {
    mapPlace = vec2(0.0);
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // outside of the clip volume
    return;
  }
  ivec2 at = place + ivec2(corner & 1, corner >> 1);
  mapPlace = vec2(at) / float(cells);
  vec2 onPlane = square.xy + square.z * (2.0 * mapPlace - 1.0);
  vec3 p = throughLens((cameraFromAttach * vec4(onPlane, 0.0, 1.0)).xyz);
  gl_Position = vec4(clipFocal * p.xy + clipCentre * p.z, 0.0, p.z);
}
