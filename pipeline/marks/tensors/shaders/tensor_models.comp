// Purpose: the tensors of the virtual objects in each region, apart from the background's
//          (tensor_regions.comp): of the patch that most of the region's virtual pixels are of,
//          from the edges of its picture and from its form: the direction in which it bends least,
//          or that its author declares, and towards a silhouette that of the silhouette. Carried
//          along the motion of its surface; another patch has no part in its past, unless it is the
//          other side of a joint.
// Inputs:  tensors (gradient.frag), edge_threshold.comp's, pixelsOfFull; regionPixels: a
//          region's side in px of the full image; forms, normals, surfaceMotion (ArFrame);
//          formWeight: of the surface's form; before, labelsBefore: the previous frame's, if hasPast;
//          past: the share of them that remains; slack: by which part detail may differ from the
//          held value.
// Outputs: regions RGBA16F: as in tensor_region.glsl; labels R32UI: the patch's, 0 for none, with the
//          marks of surface_form.glsl for limbs and joints. One
//          invocation per region.
// Precision: highp.
#include "pipeline/marks/tensors/shaders/edge_bins.glsl"
#include "pipeline/marks/tensors/shaders/tensor_region.glsl"
#include "pipeline/scene/render/shaders/surface_form.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) readonly buffer Edges { EdgeStrengths frameEdges; };
layout(rgba16f, binding = 0) writeonly uniform highp image2D regions;
layout(r32ui, binding = 1) writeonly uniform highp uimage2D labels;
uniform highp sampler2D tensors;
uniform highp usampler2D forms;
uniform highp sampler2D normals;
uniform highp sampler2D surfaceMotion;
uniform highp sampler2D before;
uniform highp usampler2D labelsBefore;
uniform vec2 pixelsOfFull;
uniform float regionPixels;
uniform float formWeight;
uniform bool hasPast;
uniform float past;
uniform float slack;

uint labelAt(ivec2 p) { return labelOf(texelFetch(forms, p, 0).r); }

// Boyer and Moore's majority vote over the virtual pixels.
uint labelOfMost(ivec2 low, ivec2 high) {
  uint most = 0u;
  int lead = 0;
  for (int y = low.y; y < high.y; ++y) {
    for (int x = low.x; x < high.x; ++x) {
      uint label = labelAt(ivec2(x, y));
      if (label == 0u) continue;
      if (lead == 0) most = label;
      lead += label == most ? 1 : -1;
    }
  }
  return most;
}

const float kDeclaredLead = 4.0;  // times a curvature's: shading does not turn strokes from it

// The tensor of strokes that the form asks for; its length says how clearly.
vec2 formAt(ivec2 p) {
  uint own = texelFetch(forms, p, 0).r;
  vec2 bent = tensorOf(own);
  vec2 tilt = 2.0 * texelFetch(normals, p, 0).xy - 1.0;
  float steep = dot(tilt, tilt);
  vec2 silhouette =
      vec2(tilt.x * tilt.x - tilt.y * tilt.y, 2.0 * tilt.x * tilt.y) / max(steep, 1e-4);
  float lead = isDeclared(own) ? kDeclaredLead : 1.0;
  return lead * mix(bent, silhouette, smoothstep(0.7, 0.95, steep));
}

// The motion of the patch's pixels, and their moments for its rotation.
struct Carried {
  vec2 place;
  vec2 displacement;
  float squares;
  float turning;
  float pixels;
};

// The mean of the past around a place, of this patch only, or across a joint; w < 0: there is none.
vec4 pastAt(vec2 px, uint own) {
  vec2 texel = px / regionPixels - 0.5;
  ivec2 first = ivec2(floor(texel));
  vec2 part = texel - floor(texel);
  ivec2 last = textureSize(before, 0) - 1;
  vec4 sum = vec4(0.0);
  float weights = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 step = ivec2(i & 1, i >> 1);
    ivec2 at = first + step;
    if (any(lessThan(at, ivec2(0))) || any(greaterThan(at, last))) continue;
    uint there = texelFetch(labelsBefore, at, 0).r;
    if (labelOf(there) != labelOf(own) && !isOneJoint(there, own)) continue;
    vec2 near = mix(1.0 - part, part, vec2(step));
    sum += near.x * near.y * texelFetch(before, at, 0);
    weights += near.x * near.y;
  }
  return weights > 0.05 ? sum / weights : vec4(0.0, 0.0, 0.0, -1.0);
}

void main() {
  ivec2 region = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(region, imageSize(regions)))) return;
  ivec2 low = ivec2(floor(vec2(region) * regionPixels * pixelsOfFull));
  ivec2 high =
      min(ivec2(floor(vec2(region + 1) * regionPixels * pixelsOfFull)), textureSize(forms, 0));
  uint label = labelOfMost(low, high);
  if (label == 0u) {
    imageStore(labels, region, uvec4(0u));
    imageStore(regions, region, vec4(0.0));
    return;
  }
  vec2 at = (vec2(region) + 0.5) * regionPixels;
  Edge seen = kNoEdge;
  uint limb = 0u;
  float atJoint = 0.0;
  float pixels = 0.0;
  Carried carried = Carried(vec2(0.0), vec2(0.0), 0.0, 0.0, 0.0);
  for (int y = low.y; y < high.y; ++y) {
    for (int x = low.x; x < high.x; ++x) {
      ivec2 p = ivec2(x, y);
      uint form = texelFetch(forms, p, 0).r;
      if (labelOf(form) != label) continue;
      limb = form & kOnLimb;
      atJoint += (form & kAtJoint) != 0u ? 1.0 : 0.0;
      pixels += 1.0;
      add(seen, texelFetch(tensors, p, 0).xy, 1.0, frameEdges.leadingThreshold);
      vec2 lead = formWeight * formAt(p);
      seen.sum += lead;
      seen.strengths += length(lead);
      seen.sure += length(lead);
      vec4 moved = texelFetch(surfaceMotion, p, 0);
      if (!hasPast || moved.w == 0.0) continue;
      vec2 arm = (vec2(p) + 0.5) / pixelsOfFull - at;
      vec2 displacement = moved.xy / pixelsOfFull;
      carried.place += arm;
      carried.displacement += displacement;
      carried.squares += dot(arm, arm);
      carried.turning += arm.x * displacement.y - arm.y * displacement.x;
      carried.pixels += 1.0;
    }
  }
  uint own = label | limb | (atJoint > 0.3 * pixels ? kAtJoint : 0u);
  imageStore(labels, region, uvec4(own));
  vec4 now = regionOf(seen, frameEdges.threshold, pixelsOfFull.x);
  if (carried.pixels > 0.0) {
    vec2 arm = carried.place / carried.pixels;
    vec2 displacement = carried.displacement / carried.pixels;
    // Least squares about the mean; a single pixel tells no rotation.
    float squares = carried.squares - carried.pixels * dot(arm, arm) + 1.0;
    float turn = (carried.turning -
                  carried.pixels * (arm.x * displacement.y - arm.y * displacement.x)) / squares;
    vec4 old = pastAt(at - displacement, own);
    if (old.w >= 0.0) {
      old.xy = turned(old.xy, turn);
      now = held(now, old, past, slack);
    }
  }
  imageStore(regions, region, now);
}
