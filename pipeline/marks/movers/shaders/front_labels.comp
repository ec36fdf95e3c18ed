// Purpose: labels of movers where they are seen: not where a virtual model is before them
//          (marks::FrontMovers).
// Inputs:  busy_blocks.glsl's; labels, shares: MotionLayers', also behind models; front
//          (front_movers.comp); ids (ArFrame), of pixelsOfFull, in which models are not hidden yet.
// Outputs: seenLabels RGBA16F, seenShares RGBA8: the same, 0 on models. A group of invocations per
//          block of the second list of busy_blocks.glsl; elsewhere both are 0.
// Precision: highp.
#include "pipeline/marks/movers/shaders/busy_blocks.glsl"
#include "pipeline/marks/movers/shaders/layer_cells.glsl"
#include "pipeline/scene/render/shaders/object_id.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba16f, binding = 0) writeonly uniform highp image2D seenLabels;
layout(rgba8, binding = 1) writeonly uniform highp image2D seenShares;
uniform highp sampler2D labels;
uniform highp sampler2D shares;
uniform highp sampler2D front;
uniform highp usampler2D ids;
uniform vec2 pixelsOfFull;

void main() {
  if (isBeyond(kBusyCommand)) return;
  ivec2 block = blockOf(busyWords[busyAt(int(gl_WorkGroupID.x))]);
  ivec2 cell = block * kLayerBlock + ivec2(gl_LocalInvocationID.xy);
  if (any(greaterThanEqual(cell, imageSize(seenLabels)))) return;
  ivec2 pixel = ivec2((vec2(cell) + 0.5) * kLayerCellPixels * pixelsOfFull);
  uint object = objectOf(texelFetch(ids, min(pixel, textureSize(ids, 0) - 1), 0).r);
  bool isHidden = isVirtual(object) && texelFetch(front, cell, 0).g <= 0.5;
  imageStore(seenLabels, cell, isHidden ? vec4(0.0) : texelFetch(labels, cell, 0));
  imageStore(seenShares, cell, isHidden ? vec4(0.0) : texelFetch(shares, cell, 0));
}
