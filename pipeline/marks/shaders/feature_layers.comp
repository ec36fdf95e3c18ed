// Purpose: the layer of each feature of the camera image: the real object of the scene (an
//          occluder) that it lies on, or none. Features beside a border belong to neither side.
// Inputs:  ids (ArFrame::ids), size and pixelsOfFull of its image; count.
// Outputs: features: the layer (feature.glsl). One invocation per feature.
// Precision: integers; highp for places.
#include "pipeline/marks/shaders/feature.glsl"
#include "pipeline/scene/render/shaders/object_id.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer Features { Feature features[]; };
uniform highp usampler2D ids;
uniform vec2 pixelsOfFull;
uniform int count;

const int kReach = 3;  // px: about half of a feature's window

// Virtual objects cover the camera image, which goes on behind them.
uint layerAt(ivec2 pixel) {
  uint object = objectOf(texelFetch(ids, clamp(pixel, ivec2(0), textureSize(ids, 0) - 1), 0).r);
  return object >= kRealObject ? object : 0u;
}

void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i >= count) return;
  ivec2 pixel = ivec2(floor(features[i].places.zw * pixelsOfFull));
  uint layer = layerAt(pixel);
  bool isInside = layerAt(pixel + ivec2(kReach, 0)) == layer && layerAt(pixel - ivec2(kReach, 0)) == layer &&
                  layerAt(pixel + ivec2(0, kReach)) == layer && layerAt(pixel - ivec2(0, kReach)) == layer;
  features[i].about.y = isInside ? float(layer) : -1.0;
}
