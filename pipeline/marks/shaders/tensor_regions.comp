// Purpose: the tensors of a region's edge pixels, summed and divided by their strengths (thesis
//          §4.2, step 1), and carried along the motion from frame to frame.
// Inputs:  tensors (gradient.frag), threshold (edge_threshold.comp), pixelsOfFull; regionPixels: a
//          region's side in px of the full image; before: the previous frame's regions, motion
//          (MotionField's), if hasPast; past: the share of it that remains; slack: by which part
//          detail may differ from the held value.
// Outputs: regions RGBA16F: tensor (its length is the agreement of its pixels, in [0, 1]), its
//          confidence in [0, 1]; detail: the mean P in thresholds. One invocation per region.
// Precision: highp.
#include "pipeline/marks/shaders/edge_bins.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) readonly buffer Edges { EdgeStrengths frameEdges; };
layout(rgba16f, binding = 0) writeonly uniform highp image2D regions;
uniform highp sampler2D tensors;
uniform highp sampler2D before;
uniform highp sampler2D motion;
uniform vec2 pixelsOfFull;
uniform vec2 fullSize;
uniform float regionPixels;
uniform bool hasPast;
uniform float past;
uniform float slack;

// So many px of strong edge give full confidence.
const float kSurePixels = 4.0;

// Rotates a tensor by an angle.
vec2 turned(vec2 tensor, float angle) {
  float c = cos(2.0 * angle);
  float s = sin(2.0 * angle);
  return vec2(c * tensor.x - s * tensor.y, s * tensor.x + c * tensor.y);
}

void main() {
  ivec2 region = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(regions);
  if (any(greaterThanEqual(region, size))) return;
  ivec2 pictureSize = textureSize(tensors, 0);
  ivec2 low = ivec2(floor(vec2(region) * regionPixels * pixelsOfFull));
  ivec2 high = min(ivec2(floor(vec2(region + 1) * regionPixels * pixelsOfFull)), pictureSize);
  vec2 sum = vec2(0.0);
  float strengths = 0.0;
  float sure = 0.0;
  float edges = 0.0;
  for (int y = low.y; y < high.y; ++y) {
    for (int x = low.x; x < high.x; ++x) {
      vec2 tensor = texelFetch(tensors, ivec2(x, y), 0).xy;
      float p = length(tensor);
      // A soft threshold, so that noise does not switch it.
      float weight = smoothstep(0.6, 1.4, p / frameEdges.threshold);
      sum += weight * tensor;
      strengths += weight * p;
      sure += weight;
      edges += p;
    }
  }
  vec2 extent = vec2(high - low);
  float pixels = max(extent.x * extent.y, 1.0);
  vec4 now = vec4(strengths > 0.0 ? sum / strengths : vec2(0.0),
                  min(sure / (kSurePixels * pixelsOfFull.x), 1.0), edges / (pixels * frameEdges.threshold));
  if (hasPast) {
    vec2 at = (vec2(region) + 0.5) * regionPixels;
    vec4 moved = textureLod(motion, at / fullSize, 0.0);
    vec2 from = at - moved.xy;
    vec2 texel = 16.0 / fullSize;
    vec2 dx = textureLod(motion, at / fullSize + vec2(texel.x, 0.0), 0.0).xy -
              textureLod(motion, at / fullSize - vec2(texel.x, 0.0), 0.0).xy;
    vec2 dy = textureLod(motion, at / fullSize + vec2(0.0, texel.y), 0.0).xy -
              textureLod(motion, at / fullSize - vec2(0.0, texel.y), 0.0).xy;
    float turn = 0.5 * (dx.y - dy.x) / 32.0;
    bool isInside = all(greaterThanEqual(from, vec2(0.0))) && all(lessThan(from, fullSize));
    if (isInside && moved.z < 4.0) {
      vec4 old = textureLod(before, from / (vec2(size) * regionPixels), 0.0);
      old.xy = turned(old.xy, turn);
      // The past counts by its confidence; a direction that has vanished fades.
      float oldWeight = past * old.z;
      float newWeight = (1.0 - past) * now.z;
      vec2 tensor = oldWeight + newWeight > 0.0
                        ? (oldWeight * old.xy + newWeight * now.xy) / (oldWeight + newWeight)
                        : vec2(0.0);
      // Detail is held until it differs by more than its slack, so that noise moves no region to
      // another layer.
      float detail = clamp(old.w, now.w * (1.0 - slack), now.w / (1.0 - slack));
      now = vec4(tensor, oldWeight + newWeight, mix(detail, old.w, past));
    }
  }
  imageStore(regions, region, now);
}
