// Purpose: which movers are before virtual models (marks::FrontMovers): those that cover a footprint,
//          and what hangs together with them.
// Inputs:  busy_blocks.glsl's; labels: MotionLayers', also behind models; before: the last output, if hasPast;
//          passed: what it has lost since; ids (ArFrame), of pixelsOfFull; Footprints: corners of
//          footprintCount convex quadrilaterals, px of the full image.
// Outputs: front RGBA16F: how surely the mover there is before models: 1 over a footprint, falling;
//          and whether models are to be hidden, which real things' models are not. A group of
//          invocations per block of the second list of busy_blocks.glsl; elsewhere is no mover.
//          Hiding: the command that draws what is hidden, which has an instance if anything is.
// Precision: highp.
#include "pipeline/gpu/shaders/draw_command.glsl"
#include "pipeline/marks/movers/shaders/busy_blocks.glsl"
#include "pipeline/marks/movers/shaders/layer_cells.glsl"
#include "pipeline/scene/render/shaders/object_id.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba16f, binding = 0) writeonly uniform highp image2D front;
const int kMaxFootprints = 16;
layout(std430, binding = 2) buffer Hiding { DrawCommand hiding; };
layout(std140, binding = 0) uniform Footprints { vec4 corners[2 * kMaxFootprints]; };
uniform highp sampler2D labels;
uniform highp sampler2D before;
uniform highp usampler2D ids;
uniform int footprintCount;
uniform bool hasPast;
uniform float passed;
uniform vec2 pixelsOfFull;

float sideOf(vec2 px, vec2 from, vec2 to) {
  vec2 along = to - from;
  vec2 away = px - from;
  return along.x * away.y - along.y * away.x;
}

bool isInside(vec2 px, vec4 first, vec4 second) {
  vec4 sides = vec4(sideOf(px, first.xy, first.zw), sideOf(px, first.zw, second.xy),
                    sideOf(px, second.xy, second.zw), sideOf(px, second.zw, first.xy));
  return all(greaterThanEqual(sides, vec4(0.0))) || all(lessThanEqual(sides, vec4(0.0)));
}

bool coversFootprint(vec2 px) {
  for (int i = 0; i < footprintCount; ++i) {
    if (isInside(px, corners[2 * i], corners[2 * i + 1])) return true;
  }
  return false;
}

bool isMover(ivec2 cell, ivec2 size) {
  if (any(lessThan(cell, ivec2(0))) || any(greaterThanEqual(cell, size))) return false;
  return texelFetch(labels, cell, 0).r > 0.5;
}

// The most that the mover had around the cell. What is between must belong to it as well.
float frontAround(ivec2 cell, ivec2 size) {
  float most = texelFetch(before, cell, 0).r;
  for (int reach = 2; reach <= 8; reach *= 2) {
    for (int i = 0; i < 9; ++i) {
      ivec2 way = ivec2(i % 3 - 1, i / 3 - 1) * reach;
      if (!isMover(cell + way, size) || !isMover(cell + way / 2, size)) continue;
      most = max(most, texelFetch(before, cell + way, 0).r);
    }
  }
  return most;
}

void main() {
  if (isBeyond(kBusyCommand)) return;
  ivec2 block = blockOf(busyWords[busyAt(int(gl_WorkGroupID.x))]);
  ivec2 cell = block * kLayerBlock + ivec2(gl_LocalInvocationID.xy);
  ivec2 size = imageSize(front);
  if (any(greaterThanEqual(cell, size))) return;
  float stays = 0.0;
  if (isMover(cell, size)) {
    vec2 px = (vec2(cell) + 0.5) * kLayerCellPixels;
    stays = hasPast ? max(frontAround(cell, size) - passed, 0.0) : 0.0;
    if (coversFootprint(px)) stays = 1.0;
  }
  ivec2 pixel = ivec2((vec2(cell) + 0.5) * kLayerCellPixels * pixelsOfFull);
  uint object = objectOf(texelFetch(ids, min(pixel, textureSize(ids, 0) - 1), 0).r);
  bool hides = stays > 0.0 && (object == 0u || isVirtual(object));
  if (hides) hiding.instanceCount = 1u;  // all write the same
  imageStore(front, cell, vec4(stays, hides ? 1.0 : 0.0, 0.0, 0.0));
}
