// Purpose: compares each cell of the picture with the remembered background and with the previous
//          frame; what movers may carry is left to motion_layers_near.comp.
// Defines: motion_layers.glsl's.
// Inputs:  motion_layers_compare.glsl's.
// Outputs: candidates RGBA8: how surely it is other content than the background, the carried label,
//          luma now and of the background. evidence RGBA16F: whether it has changed since the
//          previous frame, or -2 where another real thing's model was before;
//          carried rest, carried maturity (below 0: a mover has left), carried freshness.
//          pictureNow RGBA8: the picture in cells, and in A the real thing that it shows.
//          otherCells: how many cells are surely other content. busy_blocks.glsl's flags. One
//          invocation per cell.
// Precision: highp.
#include "pipeline/marks/movers/shaders/busy_blocks.glsl"
#include "pipeline/marks/movers/shaders/motion_layers_compare.glsl"
layout(local_size_x = 16, local_size_y = 4) in;
layout(rgba8, binding = 2) writeonly uniform highp image2D pictureNow;

// Less than any of join's conditions; candidates are rounded to 1/255.
const float kLeastBusy = 0.06;
const float kLeastLabel = 0.4;

void main() {
  ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(cell, imageSize(candidates)))) return;
  Seen seen = seenAt(cell);
  imageStore(pictureNow, cell, vec4(seen.now, seen.thing / 255.0));
  bool another = isAnother(seen);
  if (!hasPast || another || !isInPicture(seen.from)) {
    float luma = lumaOf(seen.now);
    imageStore(candidates, cell, vec4(0.0, 0.0, luma, luma));
    imageStore(evidence, cell, vec4(another ? -2.0 : 0.0, 0.0, 0.0, 0.0));
    return;
  }
  Compared c = compared(seen);
  if (c.other > 0.5) atomicAdd(otherCells[turn], 1u);
  store(cell, seen.now, c, 0.0);
  uint flags = mayBeMover(c) ? kMayBeMover : 0u;
  if (c.isMoving || c.label.r > kLeastLabel) flags |= kIsNear;
  if (c.other > kLeastBusy || c.label.r > kLeastLabel) flags |= kIsBusy;
  if (flags != 0u) atomicOr(busyWords[flagsAt(cell / kLayerBlock)], flags);
}
