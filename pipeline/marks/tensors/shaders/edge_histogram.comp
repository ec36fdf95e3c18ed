// Purpose: the distribution of the frame's edge strengths: a histogram of every fourth pixel's P,
//          without virtual objects and movers, so that what comes in changes nothing elsewhere.
// Defines: has_objects.glsl's.
// Inputs:  tensors (gradient.frag); ids (ArFrame) if hasObjects; edge_parts.glsl's; pixelsOfFull.
// Outputs: bins, which were 0 (edge_threshold.comp). One invocation per pixel.
// Precision: integer counts, so that order does not matter.
#include "pipeline/marks/tensors/shaders/edge_bins.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) buffer Edges { EdgeStrengths frameEdges; };
uniform highp sampler2D tensors;
uniform highp usampler2D ids;
uniform vec2 pixelsOfFull;
#include "pipeline/marks/tensors/shaders/edge_parts.glsl"
#include "pipeline/scene/render/shaders/has_objects.glsl"
#include "pipeline/scene/render/shaders/object_id.glsl"

shared uint counted[kBins];

void main() {
  uint me = gl_LocalInvocationIndex;
  for (uint i = me; i < uint(kBins); i += 64u) counted[i] = 0u;
  barrier();
  ivec2 at = ivec2(gl_GlobalInvocationID.xy) * 2;
  if (all(lessThan(at, textureSize(tensors, 0))) &&
      !(hasObjects && isVirtual(objectOf(texelFetch(ids, at, 0).r))) &&
      edgePartsAt((vec2(at) + 0.5) / pixelsOfFull).x > 0.5) {
    atomicAdd(counted[binOf(length(texelFetch(tensors, at, 0).xy))], 1u);
  }
  barrier();
  for (uint i = me; i < uint(kBins); i += 64u) {
    if (counted[i] > 0u) atomicAdd(frameEdges.bins[i], counted[i]);
  }
}
