// Purpose: for each cell its exact mean colour (thesis §3.2.1) and its seed's next place: the mean of
//          its edge pixels if there are enough (§3.2.3), else it stays, or drifts home.
// Inputs:  sums (tile.comp; emptied here for the next frame), picture, grid (n, m), cellPixels, seed,
//          minEdgePixels, follow and drift: the parts in [0, 1] of the way to the edge and home.
// Outputs: seeds; means (RGBA16F): linear mean, and 1 where the cell has pixels: an empty cell has
//          the colour under its seed; shifts (RGBA16F): how far the seed that made this tiling was
//          from home, px.
// Precision: sums are exact; seeds end on the lattice of home.glsl.
#include "pipeline/gpu/shaders/colour.glsl"
#include "pipeline/styles/watercolor/shaders/home.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) buffer Seeds { vec2 seeds[]; };
layout(std430, binding = 1) buffer Sums { uint sums[]; };
layout(binding = 0, rgba16f) writeonly uniform highp image2D means;
layout(binding = 1, rgba16f) writeonly uniform highp image2D shifts;
uniform sampler2D picture;
uniform ivec2 grid;
uniform vec2 cellPixels;
uniform uint seed;
uniform uint minEdgePixels;
uniform float follow;
uniform float drift;

void main() {
  ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(cell, grid))) return;
  int index = cell.y * grid.x + cell.x;
  vec2 home = homeOf(cell, cellPixels, seed);
  vec2 at = seeds[index];

  float count = float(sums[index * 8 + 3]);
  vec3 mean;
  if (count > 0.0) {
    vec3 sum = vec3(uvec3(sums[index * 8], sums[index * 8 + 1], sums[index * 8 + 2]));
    mean = sum / (count * 16384.0);
  } else {
    ivec2 under = min(ivec2(at), textureSize(picture, 0) - 1);
    mean = linearFromSrgb(texelFetch(picture, under, 0).rgb);
  }
  imageStore(means, cell, vec4(mean, count > 0.0 ? 1.0 : 0.0));
  imageStore(shifts, cell, vec4(at - home, 0.0, 0.0));

  uint edges = sums[index * 8 + 6];
  vec2 next = mix(at, home, drift);
  if (edges >= minEdgePixels) {
    uvec2 edgeSum = uvec2(sums[index * 8 + 4], sums[index * 8 + 5]);
    // Whole pixels first: a sum can have more bits than a float.
    uvec2 whole = edgeSum / edges;
    vec2 target = vec2(whole) + vec2(edgeSum - whole * edges) / float(edges) + 0.5;
    next = mix(at, target, follow);
  }
  seeds[index] = clampedSeed(next, cell, home, grid, cellPixels);
  for (int i = 0; i < 8; ++i) sums[index * 8 + i] = 0u;
}
