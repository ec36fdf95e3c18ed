// Purpose: gives a region without a direction that of its neighbours, by radial-basis interpolation
//          over 5x5 regions (thesis §4.2, step 2, with eq. 12's weights).
//          Directions do not spread from one segment of the camera image to another (§6.2); a region
//          is of the segment at its middle.
// Inputs:  regions (tensor_regions.comp or tensor_reduce.comp); sigma: in regions; segments.glsl's;
//          regionPixels: a region's side in px of the full image, if hasSegments.
// Outputs: filled RGBA16F, same layout. One invocation per region.
// Precision: highp.
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba16f, binding = 0) writeonly uniform highp image2D filled;
uniform highp sampler2D regions;
uniform float sigma;
uniform float regionPixels;
#include "pipeline/marks/tensors/shaders/segments.glsl"

uint segmentOfRegion(ivec2 region) {
  return coarseSegmentAt((vec2(region) + 0.5) * regionPixels);
}

void main() {
  ivec2 region = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(filled);
  if (any(greaterThanEqual(region, size))) return;
  vec4 own = texelFetch(regions, region, 0);
  uint segment = segmentOfRegion(region);
  vec2 sum = vec2(0.0);
  float weights = 0.0;
  for (int y = -2; y <= 2; ++y) {
    for (int x = -2; x <= 2; ++x) {
      ivec2 at = region + ivec2(x, y);
      if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) continue;
      if (segment != 0u && !mayCover(segment, segmentOfRegion(at))) continue;
      vec4 there = texelFetch(regions, at, 0);
      float weight = exp(-length(vec2(x, y)) / sigma) * there.z;
      sum += weight * there.xy;
      weights += weight;
    }
  }
  vec2 around = weights > 1e-4 ? sum / weights : vec2(0.0);
  // A region that is half sure of its own direction takes half of its neighbours'.
  float known = max(own.z, smoothstep(0.0, 0.1, weights) * (1.0 - own.z));
  imageStore(filled, region, vec4(mix(around, own.xy, own.z), known, own.w));
}
