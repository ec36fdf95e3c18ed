// Purpose: finds the plain parts of movers in place: what has moved, and is enclosed by other content.
//          They look as what is remembered there, and so are no other content themselves.
// Inputs:  displacements (mover_displacement.comp); candidates (motion_layers_compare.glsl); farReach:
//          blocks that are looked at on a ray.
// Outputs: inPlace: R: 1 in such a part, else 0. A group of invocations per block of the second list
//          of busy_blocks.glsl.
// Precision: highp.
#include "pipeline/marks/movers/shaders/busy_blocks.glsl"
#include "pipeline/marks/movers/shaders/mover_displacement.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba8, binding = 0) writeonly uniform highp image2D inPlace;
uniform highp sampler2D displacements;
uniform highp sampler2D candidates;
uniform int farReach;

const int kNearReach = 8;     // cells of which some are looked at, and blocks beyond them
const int kLeastSides = 5;    // of the eight: with other content
const int kMostOpen = 1;      // – without
const int kMostKeptOpen = 2;  // – without, of what was a mover's

bool isOutside(ivec2 at, ivec2 size) {
  return any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size));
}

// What is on the ray from a cell: X: 1 for other content, Y: 1 for none; neither where the image
// ends, which cuts people off.
ivec2 onRay(ivec2 cell, ivec2 along, ivec2 size) {
  for (int away = 1; away <= kNearReach; away += 1 + away / 2) {
    ivec2 at = cell + away * along;
    if (isOutside(at, size)) return ivec2(0);
    if (texelFetch(candidates, at, 0).r > 0.5) return ivec2(1, 0);
  }
  for (int i = 1; i <= farReach; ++i) {
    ivec2 block = cell / kLayerBlock + i * along;
    if (isOutside(block, grid)) return ivec2(0);
    if (boundsMover(texelFetch(displacements, block, 0))) return ivec2(1, 0);
  }
  return ivec2(0, 1);
}

void main() {
  if (isBeyond(kBusyCommand)) return;
  ivec2 block = blockOf(busyWords[busyAt(int(gl_WorkGroupID.x))]);
  ivec2 cell = block * kLayerBlock + ivec2(gl_LocalInvocationID.xy);
  ivec2 size = textureSize(candidates, 0);
  if (isOutside(cell, size)) return;
  // Other content is a mover's or has been uncovered, which is for others to tell.
  vec2 own = texelFetch(candidates, cell, 0).rg;
  bool mayBe = own.r <= 0.5 && mayBeInPlace(texelFetch(displacements, block, 0));
  ivec2 sides = ivec2(0);
  for (int i = 0; i < (mayBe ? 8 : 0); ++i) {
    ivec2 along = i < 2 ? ivec2(1, 0) : ivec2(i / 2 - 2, 1);
    sides += onRay(cell, (i & 1) != 0 ? -along : along, size);
  }
  bool isPart = sides.x >= kLeastSides && sides.y <= (own.g > 0.5 ? kMostKeptOpen : kMostOpen);
  imageStore(inPlace, cell, vec4(isPart ? 1.0 : 0.0, 0.0, 0.0, 0.0));
}
