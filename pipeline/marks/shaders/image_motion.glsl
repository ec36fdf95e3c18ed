// Purpose: the motion of a point of the camera image since the previous frame, forward from its old
//          place or backward from its new one: of all available sources, the one with the smallest
//          predicted error.
// Inputs:  those that marks::MotionField binds: uniform blocks 1 to 3, flow and still;
//          bodies.glsl's, of a camera with the full image's pixels.
// Outputs: displacement, predicted error, source (anchor.glsl), and afterwards the Jacobian. All px of
//          the full image.
// Precision: highp. Displacements are sums of differences, so that a static image gives exactly 0.
#include "pipeline/marks/anchors/shaders/anchor.glsl"
#include "pipeline/marks/shaders/feature.glsl"
#include "pipeline/scene/render/shaders/planes.glsl"

const int kMaxFeatures = 256;  // tracking::kMaxMovedFeatures
const float kUnknownError = 1.0e4;
const float kMinError = 1.0e-3;

layout(std140, binding = 1) uniform Planes { Body planes[kMaxPlanes]; };
layout(std140, binding = 2) uniform Motion {
  mat4 currentFromPrevious;    // the picture's homography, in the upper left 3x3
  mat4 previousFromCurrent;
  vec4 flowGrid;       // node = px * xy + zw
  vec4 stillGrid;  // field = px * xy + zw
  vec4 known;          // planes, features, whether there is a homography, its error
  vec4 nodes;          // x of flow, z of still fields; 0: none
  vec4 fullByFrame;  // px of the full image per px of the captured frame
};
layout(std140, binding = 3) uniform Features { Feature features[kMaxFeatures]; };

uniform sampler2D flow;  // RGBA32F, forward or backward like the query
uniform sampler2D still;  // R32F

// Without its Jacobian, which is found for the best source alone, by turnOf(): there are not enough
// registers for those of all sources.
struct Moved {
  vec2 displacement;
  float error;
  uint source;  // in kSourceBits; above, kStraight or the three features
};

const uint kStraight = 0x10u;  // moves without turning, whatever the source
const vec4 kNoTurn = vec4(1.0, 0.0, 0.0, 1.0);

Moved nothingKnown() { return Moved(vec2(0.0), kUnknownError, kSourceUnknown); }

// --- planes of the scene

// The point of a plane at px: (x, y) on it, and its depth, 0 if it is not there in both frames.
vec3 planeHit(Body plane, vec2 px, bool backward) {
  vec3 ray = rayThrough(px);
  vec3 hit = backward ? hitOf(plane.current, plane.extent.xy, ray)
                      : hitOf(plane.previous, plane.extent.xy, ray);
  vec4 there = backward ? plane.previous[2] : plane.current[2];
  return dot(there, vec4(hit.xy, 0.0, 1.0)) <= 0.0 ? vec3(0.0) : hit;
}

// A plane's point in the other frame, less its place here.
vec2 planeShift(Body plane, vec2 at, bool backward) {
  vec3 current = transformed(plane.current, vec3(at, 0.0));
  vec3 previous = transformed(plane.previous, vec3(at, 0.0));
  return backward ? projected(previous) - projected(current)
                  : projected(current) - projected(previous);
}

// The nearest plane at px. `depth`: of the point there; 0: there is none.
int planeAt(vec2 px, bool backward, out float depth) {
  int count = int(known.x);
  int which = 0;
  depth = 0.0;
  for (int i = 0; i < count; ++i) {
    if (planes[i].turnsAbout.w == 0.0) continue;
    float there = planeHit(planes[i], px, backward).z;
    if (there == 0.0 || (depth > 0.0 && there >= depth)) continue;
    depth = there;
    which = i;
  }
  return which;
}

Moved byPlanes(vec2 px, bool backward) {
  float depth;
  int which = planeAt(px, backward, depth);
  if (depth == 0.0) return nothingKnown();
  vec3 hit = planeHit(planes[which], px, backward);
  vec2 shift = planeShift(planes[which], hit.xy, backward);
  return Moved(shift, predictedError(planes[which], depth * rayThrough(px)), kSourcePlane);
}

vec4 turnOfPlane(vec2 px, bool backward) {
  float depth;
  int which = planeAt(px, backward, depth);
  // Here, and a pixel further in x and in y. Not unrolled, for its bound is no constant.
  vec2 shift = vec2(0.0);
  vec2 inX = vec2(0.0);
  vec4 jacobian = kNoTurn;
  int samples = depth == 0.0 ? 0 : 3;
  for (int i = 0; i < samples; ++i) {
    vec3 hit = planeHit(planes[which], px + vec2(i & 1, i >> 1), backward);
    if (hit.z == 0.0) break;
    vec2 there = planeShift(planes[which], hit.xy, backward);
    if (i == 0) shift = there;
    if (i == 1) inX = there - shift;
    if (i == 2) jacobian += vec4(inX, there - shift);
  }
  return jacobian;
}

// --- the image as a whole

vec2 homographyShift(mat3 h, vec2 px) {
  vec3 p = h * vec3(px, 1.0);
  // p.xy / p.z - px, without the difference of large numbers
  return vec2(dot(vec3(h[0][0] - 1.0, h[1][0], h[2][0]), vec3(px, 1.0)) - px.x * (p.z - 1.0),
              dot(vec3(h[0][1], h[1][1] - 1.0, h[2][1]), vec3(px, 1.0)) - px.y * (p.z - 1.0)) / p.z;
}

mat3 pictureHomography(bool backward) {
  return mat3(backward ? previousFromCurrent : currentFromPrevious);
}

Moved byPicture(vec2 px, bool backward) {
  if (known.z == 0.0) return nothingKnown();
  return Moved(homographyShift(pictureHomography(backward), px), known.w, kSourcePicture);
}

vec4 turnOfPicture(vec2 px, bool backward) {
  mat3 h = pictureHomography(backward);
  float w = dot(vec3(h[0][2], h[1][2], h[2][2]), vec3(px, 1.0));
  vec2 image = px + homographyShift(h, px);
  return vec4(h[0][0] - image.x * h[0][2], h[0][1] - image.y * h[0][2],
              h[1][0] - image.x * h[1][2], h[1][1] - image.y * h[1][2]) / w;
}

// --- the three nearest features of the same layer (thesis §4.3.3)

struct Neighbour {
  vec2 at;  // previous; current in backward queries
  vec2 shift;
  float error;
};
struct Neighbours {
  Neighbour of[3];
};

// Their numbers, each in 8 bits from kFeatureShift on. `away`: the distance of the nearest one;
// negative where there are fewer than three.
const uint kFeatureShift = 8u;
uint nearestFeatures(vec2 px, float layer, bool backward, out float away) {
  vec3 squared = vec3(1.0e12);  // nearest first
  ivec3 which = ivec3(-1);
  int count = int(known.y);
  for (int i = 0; i < count; ++i) {
    vec2 apart = (backward ? features[i].places.zw : features[i].places.xy) - px;
    float d = features[i].about.y == layer ? dot(apart, apart) : 1.0e12;
    bool first = d < squared.x;
    bool second = d < squared.y;
    bool third = d < squared.z;
    which = ivec3(first ? i : which.x, first ? which.x : (second ? i : which.y),
                  second ? which.y : (third ? i : which.z));
    squared = vec3(min(d, squared.x), first ? squared.x : min(d, squared.y),
                   second ? squared.y : min(d, squared.z));
  }
  away = which.z >= 0 ? sqrt(squared.x) : -1.0;
  uvec3 numbers = uvec3(max(which, 0)) << uvec3(kFeatureShift, kFeatureShift + 8u, kFeatureShift + 16u);
  return numbers.x | numbers.y | numbers.z;
}

Neighbour neighbourOf(uint numbers, int k, bool backward) {
  uint i = numbers >> (kFeatureShift + 8u * uint(k)) & 255u;
  vec4 places = features[i].places;
  return Neighbour(backward ? places.zw : places.xy,
                   (backward ? -1.0 : 1.0) * (places.zw - places.xy), features[i].about.x);
}

Neighbours neighboursOf(uint numbers, bool backward) {
  Neighbours near;
  for (int k = 0; k < 3; ++k) near.of[k] = neighbourOf(numbers, k, backward);
  return near;
}

// The best rotation, zoom and shift for all three, used where they form no triangle.
struct Similarity {
  vec2 middle;
  vec2 shift;
  vec2 turn;  // minus one
  float spread;  // 0: too little for a rotation
};

Similarity similarityOf(Neighbours near) {
  vec2 middle = (near.of[0].at + near.of[1].at + near.of[2].at) / 3.0;
  vec2 shift = (near.of[0].shift + near.of[1].shift + near.of[2].shift) / 3.0;
  float spread = 0.0;
  vec2 turn = vec2(0.0);
  for (int k = 0; k < 3; ++k) {
    vec2 a = near.of[k].at - middle;
    vec2 d = near.of[k].shift - shift;
    spread += dot(a, a);
    turn += vec2(dot(a, d), a.x * d.y - a.y * d.x);
  }
  const float kMinSpread = 9.0;  // px²: closer features give no rotation
  bool isSpread = spread > kMinSpread;
  return Similarity(middle, shift, isSpread ? turn / spread : vec2(0.0), isSpread ? spread : 0.0);
}

Moved bySimilarity(vec2 px, Neighbours near) {
  Similarity all = similarityOf(near);
  float variance = 0.0;
  for (int k = 0; k < 3; ++k) variance += near.of[k].error * near.of[k].error / 3.0;
  vec2 arm = px - all.middle;
  float lever = all.spread > 0.0 ? dot(arm, arm) / all.spread : 0.0;
  vec2 turned = vec2(all.turn.x * arm.x - all.turn.y * arm.y, all.turn.y * arm.x + all.turn.x * arm.y);
  return Moved(all.shift + turned, sqrt(variance * (1.0 / 3.0 + lever)), kSourceFeatures);
}

// A point in the triangle of three features.
struct InTriangle {
  vec2 u;  // two of its sides
  vec2 v;
  float area;
  vec3 weights;  // barycentric
  bool isClear;  // false: the triangle is flat, or far away
};

InTriangle inTriangle(vec2 px, Neighbours near) {
  InTriangle here;
  here.u = near.of[1].at - near.of[0].at;
  here.v = near.of[2].at - near.of[0].at;
  here.area = here.u.x * here.v.y - here.u.y * here.v.x;
  float longest = max(max(dot(here.u, here.u), dot(here.v, here.v)), dot(here.u - here.v, here.u - here.v));
  const float kMinHeight = 0.25;  // of the longest side: flatter triangles amplify noise
  bool isFlat = abs(here.area) <= kMinHeight * longest;  // or all in one place
  vec2 arm = px - near.of[0].at;
  float b = (arm.x * here.v.y - arm.y * here.v.x) / here.area;
  float c = (here.u.x * arm.y - here.u.y * arm.x) / here.area;
  here.weights = vec3(1.0 - b - c, b, c);
  here.isClear = !(isFlat || dot(here.weights, here.weights) > 3.0);
  return here;
}

// The previous point's barycentric coordinates, applied to the current corners (eq. 13-19).
Moved byTriangle(vec2 px, Neighbours near) {
  InTriangle here = inTriangle(px, near);
  if (!here.isClear) return bySimilarity(px, near);
  vec2 du = near.of[1].shift - near.of[0].shift;
  vec2 dv = near.of[2].shift - near.of[0].shift;
  vec2 shift = near.of[0].shift + here.weights.y * du + here.weights.z * dv;
  vec3 errors = here.weights * vec3(near.of[0].error, near.of[1].error, near.of[2].error);
  return Moved(shift, length(errors), kSourceFeatures);
}

vec4 turnOfFeatures(vec2 px, uint numbers, bool backward) {
  Neighbours near = neighboursOf(numbers, backward);
  InTriangle here = inTriangle(px, near);
  if (!here.isClear) {
    vec2 turn = similarityOf(near).turn;
    return vec4(1.0 + turn.x, turn.y, -turn.y, 1.0 + turn.x);
  }
  vec2 du = near.of[1].shift - near.of[0].shift;
  vec2 dv = near.of[2].shift - near.of[0].shift;
  return kNoTurn + vec4(here.v.y * du - here.u.y * dv, here.u.x * dv - here.v.x * du) / here.area;
}

// --- dense flow

vec4 flowNode(ivec2 node) {
  return texelFetch(flow, clamp(node, ivec2(0), textureSize(flow, 0) - 1), 0);
}

// Extrapolates between the border and the outermost nodes: constant flow would make anchors there
// drift by half a node's slope per frame. The error is not extrapolated.
vec4 flowAt(vec2 node) {
  const float kBeyond = 1.5;  // nodes: as far as anchors go beyond the border
  ivec2 corner = clamp(ivec2(floor(node)), ivec2(0), max(textureSize(flow, 0) - 2, ivec2(0)));
  vec2 part = clamp(node - vec2(corner), vec2(-kBeyond), vec2(1.0 + kBeyond));
  vec2 between = clamp(part, 0.0, 1.0);
  vec4 alongX = vec4(part.xx, between.xx);
  vec4 above = mix(flowNode(corner), flowNode(corner + ivec2(1, 0)), alongX);
  vec4 below = mix(flowNode(corner + ivec2(0, 1)), flowNode(corner + ivec2(1, 1)), alongX);
  return mix(above, below, vec4(part.yy, between.yy)) * vec4(fullByFrame.xy, fullByFrame.x, 1.0);
}

Moved byFlow(vec2 px) {
  if (nodes.x == 0.0) return nothingKnown();
  vec4 here = flowAt(px * flowGrid.xy + flowGrid.zw);
  return Moved(here.xy, here.z, kSourceFlow);
}

vec4 turnOfFlow(vec2 px) {
  vec4 jacobian = kNoTurn;
  vec2 node = px * flowGrid.xy + flowGrid.zw;
  vec2 before = vec2(0.0);
  // Before and behind, in x and in y. Not unrolled, for its bound is no constant.
  int samples = nodes.x == 0.0 ? 0 : 4;
  for (int i = 0; i < samples; ++i) {
    vec2 axis = i < 2 ? vec2(1.0, 0.0) : vec2(0.0, 1.0);
    vec2 there = flowAt((i & 1) == 0 ? node - axis : node + axis).xy;
    // Central differences over two nodes: the flow is smooth, its noise is not.
    vec2 slope = (there - before) * 0.5;
    if (i == 1) jacobian.xy += slope * flowGrid.x;
    if (i == 3) jacobian.zw += slope * flowGrid.y;
    before = there;
  }
  return jacobian;
}

// --- static regions

float stillError(vec2 px) {
  if (nodes.z == 0.0) return kUnknownError;
  ivec2 field = ivec2(px * stillGrid.xy + stillGrid.zw);
  return texelFetch(still, clamp(field, ivec2(0), textureSize(still, 0) - 1), 0).r * fullByFrame.x;
}

// --- the choice

// How far a motion differs from a witness's, beyond the witness's own error.
float contradicted(Moved moved, vec2 seen, float error) {
  return max(0.0, distance(moved.displacement, seen) - 2.5 * error);
}

Moved better(Moved a, Moved b) {
  if (b.error < a.error) return b;
  return a;
}

// Of what the image itself tells at px: dense flow, the error of rest there, the neighbours, and the
// homography, plus the neighbours' residual motion, weighted by how far residuals all over the image
// exceed the features' errors: the best estimate of both (a Kalman gain). `layer`: the real object
// that px is on, or 0.
Moved bestOfImage(vec2 px, float layer, bool backward, Moved flowed, float restError) {
  float away;
  uint numbers = nearestFeatures(px, layer, backward, away);
  Moved triangle = nothingKnown();
  Moved whole = byPicture(px, backward);
  if (away >= 0.0) {
    float share = clamp(away / 64.0, 0.1, 1.0);
    bool hasPicture = known.z != 0.0;
    mat3 h = pictureHomography(backward);
    // One after the other: loops whose bound is no constant.
    int count = min(int(known.y), 3);
    vec2 mean = vec2(0.0);
    for (int k = 0; k < count; ++k) mean += neighbourOf(numbers, k, backward).shift;
    mean /= 3.0;
    vec2 apart = vec2(0.0);
    float noise = 0.0;
    for (int k = 0; k < count; ++k) {
      Neighbour near = neighbourOf(numbers, k, backward);
      apart += (near.shift - (hasPicture ? homographyShift(h, near.at) : mean)) / 3.0;
      noise += near.error * near.error / 9.0;
    }
    vec2 parallax = vec2(0.0);
    float variance = nodes.y;
    if (hasPicture && variance != 0.0) {
      float gain = variance / (variance + noise) * (1.0 - 0.5 * share);
      vec2 picture = whole.displacement;
      whole.displacement += gain * apart;
      parallax = whole.displacement - picture;
      float left = 1.0 - gain;
      whole.error = sqrt(whole.error * whole.error + gain * gain * noise + left * left * variance);
    }
    // The neighbours' residual against the homography, or among themselves, may continue between
    // them and here.
    float off = 0.0;
    for (int k = 0; k < count; ++k) {
      Neighbour near = neighbourOf(numbers, k, backward);
      vec2 expected = hasPicture ? homographyShift(h, near.at) : mean;
      off = max(off, distance(near.shift, expected + parallax) - 2.0 * near.error);
    }
    triangle = byTriangle(px, neighboursOf(numbers, backward));
    triangle.source |= numbers;
    triangle.error = length(vec2(triangle.error, 0.5 * share * off));
    triangle.error = length(vec2(triangle.error, contradicted(triangle, flowed.displacement, flowed.error)));
    triangle.error = length(vec2(triangle.error, contradicted(triangle, vec2(0.0), restError)));
    whole.error = length(vec2(whole.error, off));
  }
  whole.error = length(vec2(whole.error, contradicted(whole, flowed.displacement, flowed.error)));
  whole.error = length(vec2(whole.error, contradicted(whole, vec2(0.0), restError)));
  Moved best = better(nothingKnown(), Moved(vec2(0.0), restError, kSourceStill));
  best = better(better(best, flowed), triangle);
  return better(best, whole);
}

// The same or what the planes of the scene tell.
Moved bestWithPlane(Moved best, Moved plane, Moved flowed, float restError) {
  plane.error = length(vec2(plane.error, contradicted(plane, flowed.displacement, flowed.error)));
  plane.error = length(vec2(plane.error, contradicted(plane, vec2(0.0), restError)));
  best = better(best, plane);
  best.error = max(best.error, kMinError);
  return best;
}

Moved imageMotionAt(vec2 px, float layer, bool backward) {
  Moved flowed = byFlow(px);
  float restError = stillError(px);
  Moved best = bestOfImage(px, layer, backward, flowed, restError);
  if (layer == 0.0) return bestWithPlane(best, byPlanes(px, backward), flowed, restError);
  best.error = max(best.error, kMinError);
  return best;
}

// The Jacobian of a motion that has been found at px.
vec4 turnOf(Moved moved, vec2 px, bool backward) {
  if ((moved.source & kStraight) != 0u) return kNoTurn;
  switch (moved.source & kSourceBits) {
    case kSourcePlane: return turnOfPlane(px, backward);
    case kSourcePicture: return turnOfPicture(px, backward);
    case kSourceFeatures: return turnOfFeatures(px, moved.source, backward);
    case kSourceFlow: return turnOfFlow(px);
    default: return kNoTurn;
  }
}
