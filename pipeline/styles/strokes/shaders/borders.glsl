// Purpose: the borders at which strokes are clipped: those of virtual objects and of their patches
//          against each other and against real content, and those of movers against
//          each other and the background, two pixels wide, so that a clipped edge is smooth; and those of the camera
//          image's segments. Occluders count as real: they hide models, but the image goes on over
//          their edges. Where trunk and limb meet on a smooth surface, the border is open: strokes
//          of both fade out beyond it.
// Defines: MOVERS_ONLY: there are no objects and no segments.
// Inputs:  mover_places.glsl's; picture: the frame's; size, pixelsOfFull: of the frame. Without
//          MOVERS_ONLY: forms and depth (scene::ArFrame) if hasObjects, within objectBounds; depthRange:
//          0: no depth; segments.glsl's; before: the previous frame's borders if isHeld, while the
//          camera stands.
// Outputs: functions; borders are packed as in stroke_border.glsl.
// Precision: integers; highp for places.
#include "pipeline/scene/render/shaders/surface_form.glsl"
#include "pipeline/marks/strokes/shaders/stroke_border.glsl"
uniform highp sampler2D picture;
uniform vec2 size;
uniform vec2 pixelsOfFull;
#include "pipeline/marks/shaders/colour_difference.glsl"
#include "pipeline/marks/movers/shaders/mover_places.glsl"
#include "pipeline/marks/movers/shaders/mover_matte.glsl"
#ifndef MOVERS_ONLY
#include "pipeline/scene/render/shaders/depth_step.glsl"
#include "pipeline/marks/tensors/shaders/segments.glsl"
uniform highp usampler2D forms;
uniform highp sampler2D depth;
uniform highp usampler2D before;
uniform bool hasObjects;
uniform vec4 objectBounds;
uniform bool isHeld;
#endif

vec3 sharesOf(ivec2 p) { return sharesAt((vec2(p) + 0.5) / pixelsOfFull); }

uint labelOfShares(vec3 shares) {
  return sumOf(shares) > 0.5 ? labelOfMover(numberOf(shares)) : 0u;
}

// Whether labels of movers end within some two px; `movers`: the shares of the pixel.
bool isNearBorder(ivec2 p, vec3 movers) {
  vec3 before = sharesOf(p - 2);
  vec3 after = sharesOf(p + 2);
  bool isPlain = sumOf(movers) == 0.0 || max(movers.r, max(movers.g, movers.b)) == 1.0;
  return !isPlain || before != movers || after != movers;
}

// What is known of all pixels around one.
struct Around {
  bool hasObjects;  // there may be some
  bool isPlain;     // all of them belong to one mover, or none does
  uint plain;       // their label then
};

uint labelAt(ivec2 p, Around around) {
#ifndef MOVERS_ONLY
  uint label = around.hasObjects ? labelOf(texelFetch(forms, p, 0).r) : 0u;
  if (label != 0u) return label;
#endif
  if (around.isPlain) return around.plain;
  return labelOfShares(sharesOf(p));
}

#ifndef MOVERS_ONLY
// Whether objects are seen at the pixel or beside it.
bool isNearObjects(vec2 p) {
  return hasObjects && all(greaterThanEqual(p, objectBounds.xy - 1.0)) &&
         all(lessThanEqual(p, objectBounds.zw + 1.0));
}

float depthAt(ivec2 p, ivec2 last) {
  return texelFetch(depth, clamp(p, ivec2(0), last), 0).r;
}

// The smaller change to both sides: at an outline, the one on the surface.
float slopeOf(float before, float here, float after) {
  return abs(after - here) < abs(here - before) ? after - here : here - before;
}

// The label across a joint, if one is near: its pixels see the same surface. `near`: how near, in
// [0, 1].
uint acrossJoint(ivec2 p, ivec2 last, out float near) {
  near = 0.0;
  uint form = texelFetch(forms, p, 0).r;
  if ((form & kAtJoint) == 0u || labelOf(form) == 0u || depthRange.y == 0.0) return 0u;
  float here = depthAt(p, last);
  vec2 slope = vec2(slopeOf(depthAt(p - ivec2(1, 0), last), here, depthAt(p + ivec2(1, 0), last)),
                    slopeOf(depthAt(p - ivec2(0, 1), last), here, depthAt(p + ivec2(0, 1), last)));
  const int kStride = 2;  // px: a quarter of the reads
  float reach = kOverJoint * pixelsOfFull.x;
  int most = int(0.5 * reach) * kStride;
  uint found = 0u;
  float nearest = reach;
  for (int y = -most; y <= most; y += kStride) {
    for (int x = -most; x <= most; x += kStride) {
      float away = length(vec2(x, y));
      ivec2 at = p + ivec2(x, y);
      if (away >= nearest || any(lessThan(at, ivec2(0))) || any(greaterThan(at, last))) continue;
      uint there = texelFetch(forms, at, 0).r;
      if (labelOf(there) == labelOf(form) || !isOneJoint(form, there)) continue;
      if (isDepthStep(depthAt(at, last) - here - dot(slope, vec2(x, y)), here)) continue;
      nearest = away;
      found = labelOf(there);
    }
  }
  near = 1.0 - nearest / reach;
  return found;
}

// While the camera stands, the border between two segments stays where it is but for clear changes,
// so that noise does not move it.
uint held(SegmentBorder now, ivec2 p) {
  const float kSlack = 0.35;
  uint found = borderOf(now.own, now.other, now.share, false);
  if (!isHeld) return found;
  uint was = texelFetch(before, p, 0).r;
  bool isSame = ownOf(was) == now.own && otherOf(was) == now.other;
  bool isSwapped = ownOf(was) == now.other && otherOf(was) == now.own;
  float share = isSwapped ? 1.0 - shareOf(was) : shareOf(was);
  return (isSame || isSwapped) && abs(share - now.share) < kSlack ? was : found;
}
#endif

uint borderAt(ivec2 p) {
  ivec2 last = ivec2(size) - 1;
#ifdef MOVERS_ONLY
  bool mayBeObject = false;
#else
  bool mayBeObject = isNearObjects(vec2(p) + 0.5);
#endif
  // Labels of movers are half as fine as the full image: where one is exactly 0 or 1, so it is all
  // around. Of a loop that no invocation enters, software renderers run one round.
  vec3 movers = sharesOf(p);
  float mover = max(movers.r, max(movers.g, movers.b));
  Around around = Around(mayBeObject,
                         pixelsOfFull.x > 0.99 && (mover == 0.0 || mover == 1.0),
                         labelOfShares(movers));
  uint own = labelAt(p, around);
  uint other = own;
  float share = 0.0;
  bool isUniform = !around.hasObjects && around.isPlain;
  for (int i = isUniform ? 9 : 0; i < 9; ++i) {
    ivec2 step = ivec2(i % 3, i / 3) - 1;
    uint label = i == 4 ? own : labelAt(clamp(p + step, ivec2(0), last), around);
    float weight = float((2 - abs(step.x)) * (2 - abs(step.y))) / 16.0;
    if (label == own) {
      share += weight;
    } else if (other == own || label > other) {
      other = label;
    }
  }
  bool mayHaveMatte = !around.hasObjects && pixelsOfFull.x > 0.99 && isNearBorder(p, movers);
  Matte matte =
      matteAt((vec2(p) + 0.5) / pixelsOfFull, mayHaveMatte, picture, size / pixelsOfFull);
  if (matte.number != 0) {
    bool isOwn = matte.share > 0.5;
    own = isOwn ? labelOfMover(matte.number) : 0u;
    share = isOwn ? matte.share : 1.0 - matte.share;
    other = share > 0.98 ? own : isOwn ? 0u : labelOfMover(matte.number);
    isUniform = other == own;
  }
#ifdef MOVERS_ONLY
  return borderOf(own, other, isUniform ? 1.0 : share, false);
#else
  float near = 0.0;
  uint across = around.hasObjects ? acrossJoint(p, last, near) : 0u;
  // A border that is not open, such as an outline, clips as ever.
  bool isClosed = other != own && other != across;
  if (across != 0u && !isClosed) return borderOf(own, across, near, true);
  uint border = borderOf(own, other, isUniform ? 1.0 : share, false);
  if (!hasSegments || own != 0u) return border;
  SegmentBorder between =
      segmentBorderAt((vec2(p) + 0.5) / pixelsOfFull, picture, (vec2(p) + 0.5) / size);
  return other == own ? held(between, p) : borderOf(between.own, other, share, false);
#endif
}
