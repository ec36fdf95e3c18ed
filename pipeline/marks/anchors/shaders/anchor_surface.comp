// Purpose: the motion of the anchors on all models, by the surfaces that they lie on: each is a point
//          of its triangle (thesis §5.3). On a virtual model that is its place, and it is hidden where
//          another surface is visible instead; so are the places of dormant ones. On a real thing it is one of
//          several measurements, of which anchor_image.comp takes the best.
// Inputs:  posed_surface.glsl's; bodies, the first of a model at firstModel; bodies.glsl's, of a
//          camera with the full image's pixels; ids, depth, nearMetres, farMetres (ArFrame),
//          pixelsOfFull, fullSize, margin.
// Outputs: anchors. Those on real things keep their places; displacement, jacobian and error are the
//          surface's, and the source is kSourceSurface where they are known. One invocation per anchor.
// Precision: highp.
#include "pipeline/marks/anchors/shaders/anchor.glsl"
#include "pipeline/scene/render/shaders/bodies.glsl"
#include "pipeline/scene/render/shaders/object_id.glsl"
#include "pipeline/scene/render/shaders/posed_surface.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 2) buffer Anchors { Anchor anchors[]; };
layout(std430, binding = 3) readonly buffer Bodies { Body bodies[]; };
uniform highp usampler2D ids;
uniform highp sampler2D depth;
uniform uint firstModel;
uniform float nearMetres;
uniform float farMetres;
uniform vec2 pixelsOfFull;
uniform vec2 fullSize;
uniform float margin;
uniform uint slots;

const float kDepthTolerance = 0.002;  // of the distance, beyond the surface's own slope
const float kMaxSlope = 0.05;
const float kMaxOff = 3.0;  // px of a real anchor from its point, after which it gets another one
const vec4 kNoTurn = vec4(1.0, 0.0, 0.0, 1.0);
const float kUnknownError = 1.0e4;

float depthAt(ivec2 pixel) {
  float ndc = 2.0 * texelFetch(depth, pixel, 0).r - 1.0;
  return 2.0 * farMetres * nearMetres / (farMetres + nearMetres - ndc * (farMetres - nearMetres));
}

const uint kSeen = 0u;
const uint kOtherObject = 1u;
const uint kOtherPart = 2u;

// What is visible at px, of which the anchor's point is at `place`. A pixel shows what is at its
// middle, which at an edge may be something else: then the other three of the four around px count,
// or anchors along edges would be hidden in every other frame of a model that moves.
uint seenAt(vec2 px, uint object, vec3 place, vec3 normal) {
  vec2 at = px * pixelsOfFull;
  ivec2 pixel = ivec2(floor(at));
  ivec2 last = textureSize(ids, 0) - 1;
  if (any(lessThan(pixel, ivec2(0))) || any(greaterThan(pixel, last))) return kSeen;
  // The relative change of the surface's distance per pixel.
  float slope = length(normal.xy / (focal * pixelsOfFull)) * place.z / max(abs(dot(normal, place)), 1e-9);
  float tolerance = kDepthTolerance + min(slope, kMaxSlope);
  ivec2 aside = ivec2(greaterThan(fract(at), vec2(0.5))) * 2 - 1;
  uint seen = kSeen;
  for (int i = 0; i < 4; ++i) {
    ivec2 there = clamp(pixel + aside * ivec2(i & 1, i >> 1), ivec2(0), last);
    uint found = kOtherObject;
    if (objectOf(texelFetch(ids, there, 0).r) == object) {
      found = abs(depthAt(there) - place.z) < tolerance * place.z ? kSeen : kOtherPart;
    }
    if (found == kSeen) return kSeen;
    if (i == 0) seen = found;
  }
  return seen;
}

bool isInImage(vec2 px) {
  return all(greaterThanEqual(px, vec2(0.0))) && all(lessThan(px, fullSize));
}

// An anchor's point and its triangle, as a camera sees them in one frame.
struct View {
  vec3 place;      // m, camera frame
  vec3 normal;
  vec2 px;
  vec2 sides[2];   // px: from the first corner to the others
  float nearest;   // m: the depth of the nearest corner
};

View viewOf(vec4 pose[3], SurfacePoint point, uint firstVertex) {
  View seen;
  seen.nearest = 1.0e12;
  vec3 sum = vec3(0.0);
  vec3 first;
  vec3 second;
  vec2 firstPx;
  for (int i = 0; i < 3; ++i) {
    vec3 corner = cornerOf(point, i, firstVertex);
    sum += point.barycentrics[i] * corner;
    vec3 at = transformed(pose, corner);
    vec2 px = projected(at);
    seen.nearest = min(seen.nearest, at.z);
    if (i == 0) {
      first = at;
      firstPx = px;
    } else if (i == 1) {
      second = at;
      seen.sides[0] = px - firstPx;
    } else {
      seen.normal = normalize(cross(second - first, at - first));
      seen.sides[1] = px - firstPx;
    }
  }
  seen.place = transformed(pose, sum);
  seen.px = projected(seen.place);
  return seen;
}

// The affine map of a triangle from its previous corners to its current ones, column by column.
vec4 jacobianOf(View was, View now) {
  if (min(was.nearest, now.nearest) <= 0.0) return kNoTurn;
  vec2 u = was.sides[0];
  vec2 v = was.sides[1];
  float area = u.x * v.y - u.y * v.x;
  float longest = max(dot(u, u), dot(v, v));
  // An edge-on triangle gives no direction across it.
  if (abs(area) <= 0.02 * longest) return kNoTurn;
  vec2 a = now.sides[0];
  vec2 b = now.sides[1];
  return vec4(a * v.y - b * u.y, b * u.x - a * v.x) / area;
}

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= slots) return;
  uint state = anchors[slot].state;
  bool sleeps = isDormant(state);
  if ((!isAlive(state) && !sleeps) || (state & kOnSurface) == 0u) return;
  uint surface = anchors[slot].surface;
  uint object = objectOf(surface);
  bool isReal = !isVirtual(object);
  uint index = firstModel + (object & (kRealObject - 1u)) - 1u;
  uvec4 places = bodies[index].places;
  anchors[slot].displacement = vec2(0.0);
  anchors[slot].jacobian = kNoTurn;
  anchors[slot].error = kUnknownError;
  // A real thing is still to be seen without its model: the anchor goes on in the image.
  uint inImage = state & ~(kSourceBits | kOnSurface | kTurnedAway);
  if (places.w == 0u) {
    if (isReal && !sleeps) anchors[slot].surface = 0u;
    uint hidden = (state & (kAlive | kDying | kOnSurface)) | kHidden;
    anchors[slot].state = sleeps ? state | kHidden : isReal ? inImage : hidden;
    return;
  }

  uvec4 entry = triangles[places.x + numberOf(surface)];
  vec2 part = unpackUnorm2x16(anchors[slot].barycentrics);
  SurfacePoint point = SurfacePoint(entry.xyz, entry.w, vec3(part, 1.0 - part.x - part.y));
  View now = viewOf(bodies[index].current, point, places.y);
  if (now.place.z <= 0.0) {
    anchors[slot].state = sleeps ? state | kHidden : isReal ? inImage : stateAfter(state, true);
    return;
  }
  if (!isReal || sleeps) anchors[slot].px = now.px;
  if (sleeps && !isInImage(now.px)) {
    anchors[slot].state = state | kHidden;
    return;
  }
  uint seen = seenAt(now.px, object, now.place, now.normal);
  if (sleeps) {
    anchors[slot].state = seen == kSeen ? state & ~kHidden : state | kHidden;
    return;
  }
  uint source = kSourceUnknown;
  vec2 off = vec2(0.0);  // of a real anchor from its point
  View was;
  was.place = vec3(0.0);
  if (bodies[index].turnsAbout.w != 0.0) was = viewOf(bodies[index].previous, point, places.z);
  if (was.place.z > 0.0) {
    source = kSourceSurface;
    vec2 shift = now.px - was.px;
    vec4 jacobian = jacobianOf(was, now);
    if (isReal) {
      off = anchors[slot].px - was.px;
      shift += mat2(jacobian.xy, jacobian.zw) * off - off;
    }
    anchors[slot].displacement = shift;
    anchors[slot].jacobian = jacobian;
    anchors[slot].error = isReal ? predictedError(bodies[index], now.place) : 0.0;
  }
  if (isReal) {
    uint flags = state & ~(kSourceBits | kTurnedAway);
    if (seen == kOtherPart) flags |= kTurnedAway;
    if (dot(off, off) > kMaxOff * kMaxOff) flags &= ~kOnSurface;
    anchors[slot].state = flags | source;
    return;
  }
  bool isGone = any(lessThan(now.px, vec2(-margin))) || any(greaterThan(now.px, fullSize + margin));
  uint flags = (state & (kAlive | kDying | kOnSurface)) | (seen == kSeen ? 0u : kHidden);
  anchors[slot].state = isGone ? stateAfter(state, true) : flags | source;
}
