// Purpose: moves the anchors of the camera image, by the best of the measured motion and, on real
//          things, that of the surface (anchor_surface.comp, which has moved those on virtual models).
// Inputs:  image_motion.glsl's, flow forward; ids, barycentrics (ArFrame) and their pixelsOfFull if
//          hasObjects; bodies, the first of a model at firstModel; fullSize; onSurfaces: whether
//          anchor_surface.comp has run;
//          anchor_appearance.glsl's; margin: px beyond the border at which an anchor is removed;
//          stepSeconds; memorySeconds: how long a covered or dormant anchor is kept; mover_places.glsl's and
//          mover_motion.glsl's; restsWithCamera: the camera stands, and movers are told apart;
//          underModels: anchors that a model covers stay, as those do that a mover covers;
//          follows: whether anchors move; if not, surface anchors rest like all others, and neither
//          appearance nor labels count; anew: whether all anchors are removed.
// Outputs: anchors. One invocation per slot of occupied_slots.glsl's.
// Precision: highp.
#include "pipeline/marks/shaders/image_motion.glsl"
#include "pipeline/scene/render/shaders/object_id.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer Anchors { Anchor anchors[]; };
layout(std430, binding = 1) readonly buffer Bodies { Body bodies[]; };
uniform highp usampler2D ids;
uniform highp usampler2D barycentrics;
uniform bool hasObjects;
uniform vec2 pixelsOfFull;
uniform vec2 fullSize;
uniform float margin;
uniform float stepSeconds;
uniform float memorySeconds;
uniform bool follows;
uniform bool anew;
uniform bool onSurfaces;
uniform uint firstModel;
uniform bool restsWithCamera;
uniform bool underModels;
#include "pipeline/marks/anchors/shaders/anchor_appearance.glsl"
#include "pipeline/marks/anchors/shaders/occupied_slots.glsl"
#include "pipeline/marks/movers/shaders/layer_blocks.glsl"
#include "pipeline/marks/movers/shaders/mover_motion.glsl"

const float kOutline = 5.0;       // px around a mover in which its outline may be seen
const float kMaxFlowError = 8.0;  // px
const float kCoveredMover = 1.5;  // s: so long an anchor of a mover stays behind another one

// The motion of an anchor of the camera image. Each search is asked at one place of the text: what a
// compiler inlines twice, it has no registers for.
//
// A mover goes as how it lies on its last picture says (mover_motion.glsl): it is not still, and the
// image's homography is the background's. Dense flow beside its outline is partly the
// background's.
//
// The background moves as one; a mover's motion must not carry it along.
//
// `mover`: the number of its mover, 0 for none. It has gone about as far as in the last
// frame.
Moved measuredAt(uint slot, vec2 px, float object, int mover, bool isBesideMover, Moved flowed,
                 float restError) {
  bool isOnMover = mover != 0;
  bool isFlowKnown = flowed.error < kMaxFlowError;
  vec2 own;
  bool hasOwn = isOnMover && findMoverMotion(px + anchors[slot].displacement, mover, own);
  if (isOnMover && !hasOwn && isFlowKnown) return flowed;
  bool isResting = !isOnMover && restsWithCamera && object == 0.0;
  if (isResting) return Moved(vec2(0.0), known.w, kSourcePicture | kStraight);

  if (hasOwn) {
    const float kError = 1.0;  // px
    if (!restsWithCamera) own += byPicture(px, false).displacement;
    // The turn that flow shows within a few pixels is mostly its noise.
    return Moved(own, kError, kSourceFlow | kStraight);
  }
  bool isPlain = isOnMover || !isBesideMover;  // like every place of the image
  Moved image = isPlain ? bestOfImage(px, object, false, flowed, restError) : byPicture(px, false);
  if (object != 0.0) {
    if (isPlain) image.error = max(image.error, kMinError);
    return image;
  }
  Moved plane = byPlanes(px, false);
  if (isPlain) return bestWithPlane(image, plane, flowed, restError);
  // Before the camera, a plane may be much nearer than most of the image.
  image.error = length(vec2(image.error, contradicted(image, plane.displacement, plane.error)));
  return better(image, plane);
}

// The error of the motion of a real thing's surface, as flow and stillness see it. A mover before the
// thing says nothing about it.
float surfaceError(Moved surface, bool isBesideMover, Moved flowed, float restError) {
  if (!isBesideMover) {
    surface.error =
        length(vec2(surface.error, contradicted(surface, flowed.displacement, flowed.error)));
    surface.error = length(vec2(surface.error, contradicted(surface, vec2(0.0), restError)));
  }
  return max(surface.error, kMinError);
}

bool isReal(uint object) { return object >= kRealObject; }

// The pixel of ids at px, or -1.
ivec2 pixelAt(vec2 px) {
  ivec2 pixel = ivec2(floor(px * pixelsOfFull));
  bool isInside = hasObjects && all(greaterThanEqual(pixel, ivec2(0))) &&
                  all(lessThan(pixel, textureSize(ids, 0)));
  return isInside ? pixel : ivec2(-1);
}

// Whether an object of the camera image, 0 for none, is seen at a pixel or at an outline beside it,
// which a pose is not exact enough to place. Virtual models are where they are drawn.
bool isSeenAt(ivec2 pixel, uint object) {
  const float kOutlineError = 1.5;  // px
  uint here = objectOf(texelFetch(ids, pixel, 0).r);
  if (here == object || isVirtual(here)) return here == object;
  ivec2 reach = ivec2(kOutlineError * pixelsOfFull + 0.5);
  for (int i = 0; i < 4; ++i) {
    ivec2 at = pixel + (i < 2 ? ivec2(reach.x, 0) : ivec2(0, reach.y)) * (1 - 2 * (i & 1));
    at = clamp(at, ivec2(0), textureSize(ids, 0) - 1);
    if (objectOf(texelFetch(ids, at, 0).r) == object) return true;
  }
  return false;
}

// Whether a real thing's model was not known in the previous frame. It has not come before what was
// seen here: that was the thing.
bool isNewlyKnown(uint object) {
  return onSurfaces && bodies[firstModel + object - kRealObject - 1u].turnsAbout.w == 0.0;
}

// For how long it will have been covered or dormant, in 1/256 s, if it still is.
uint coveredFor(uint state) {
  return min((state >> kCoveredShift) + uint(256.0 * stepSeconds + 0.5), kMaxCovered);
}

void main() {
  if (gl_GlobalInvocationID.x >= occupiedCount) return;
  uint slot = occupiedSlots[gl_GlobalInvocationID.x];
  uint state = anchors[slot].state;
  if (anew) {
    anchors[slot].state = 0u;
    return;
  }
  uint longer = coveredFor(state);
  bool isForgotten = float(longer) > 256.0 * memorySeconds;
  if (isDormant(state)) {
    uint flags = (state & (kDormant | kOnSurface | kHidden)) | (onSurfaces ? 0u : kHidden);
    anchors[slot].state = isForgotten ? 0u : flags | longer << kCoveredShift;
    return;
  }
  if (!isAlive(state)) return;
  anchors[slot].ageAndRank = aged(anchors[slot].ageAndRank, stepSeconds);
  uint surface = anchors[slot].surface;
  uint object = objectOf(surface);
  vec2 px = anchors[slot].px;
  if (follows && isVirtual(object)) {
    if (onSurfaces) return;
    anchors[slot].displacement = vec2(0.0);
    anchors[slot].jacobian = kNoTurn;
    anchors[slot].error = kUnknownError;
    anchors[slot].state = (state & (kAlive | kDying | kOnSurface)) | kHidden | kSourceUnknown;
    return;
  }
  bool isOnMover = (state & kMover) != 0u;
  int mover = isOnMover ? moverOf(state) : 0;
  uint thing = object;  // that the camera image shows here
  if (isOnMover) {
    ivec2 there = pixelAt(px);
    uint before = there.x >= 0 ? objectOf(texelFetch(ids, there, 0).r) : 0u;
    thing = isReal(before) ? before : 0u;
  }
  bool isBesideMover = !isOnMover && known.z != 0.0 && isNearMover(px);
  Moved flowed = byFlow(px);
  float restError = stillError(px);
  bool hasSurface =
      !isOnMover && onSurfaces && (state & kSourceBits) == kSourceSurface && isReal(object);
  float errorOnSurface = kUnknownError;
  if (hasSurface) {
    Moved surfaceMoved = Moved(anchors[slot].displacement, anchors[slot].error, kSourceSurface);
    errorOnSurface = surfaceError(surfaceMoved, isBesideMover, flowed, restError);
  }
  Moved moved = measuredAt(slot, px, float(thing), mover, isBesideMover, flowed, restError);
  if (hasSurface) {
    // Where both are far apart, the less certain one errs by the difference.
    vec2 displacement = anchors[slot].displacement;
    moved.error = length(vec2(moved.error, contradicted(moved, displacement, anchors[slot].error)));
    moved = better(moved, Moved(displacement, errorOnSurface, kSourceSurface));
  }
  if (moved.source != kSourceSurface) anchors[slot].jacobian = turnOf(moved, px, false);
  anchors[slot].displacement = moved.displacement;
  anchors[slot].error = moved.error;
  uint source = moved.source & kSourceBits;
  // All but the source is read again: no compiler has registers for it through the search.
  memoryBarrierBuffer();
  px = anchors[slot].px + anchors[slot].displacement;
  state = anchors[slot].state;
  surface = anchors[slot].surface;
  object = objectOf(surface);
  isOnMover = (state & kMover) != 0u;
  mover = isOnMover ? moverOf(state) : 0;
  bool wasCovered = (state & kCovered) != 0u;
  longer = coveredFor(state);
  isForgotten = float(longer) > 256.0 * memorySeconds;
  bool isGone = any(lessThan(px, vec2(-margin))) || any(greaterThan(px, fullSize + margin));
  ivec2 pixel = pixelAt(px);
  uint id = pixel.x >= 0 ? texelFetch(ids, pixel, 0).r : 0u;
  if (object == 0u && !isOnMover && isReal(objectOf(id)) && isNewlyKnown(objectOf(id))) {
    object = objectOf(id);
  }
  // The image goes on behind a model: what is carried there is seen again, sooner or later.
  bool isUnderModel = underModels && follows && !isOnMover && isVirtual(objectOf(id)) &&
                      (state & (kDying | kHidden | kTurnedAway)) == 0u && !isForgotten;
  // Movers are seen before all real things.
  bool isHidden =
      pixel.x >= 0 && (isOnMover ? isVirtual(objectOf(id)) : !isSeenAt(pixel, object));
  isHidden = !isUnderModel && (isHidden || (state & kTurnedAway) != 0u);
  // Appearance is not compared behind a model, nor for an anchor known to lie on another real
  // object.
  vec2 looks = unpackedLooks(anchors[slot].appearance);
  bool isBehind = false;
  bool isInside = all(greaterThan(px, vec2(0.0))) && all(lessThan(px, fullSize));
  if (isUnderModel) {
    isBehind = true;
  } else if (follows && !isHidden && isInside) {
    vec3 shares = sharesAt(px);
    float moving = sumOf(shares);
    isBehind = !isOnMover && moving > (wasCovered ? 0.1 : 0.25);
    bool isOther = false;
    bool asksBackground = isBehind;
    if (isOnMover && moving >= 0.35 && shareOf(shares, mover) < 0.35) {
      // Another mover is before it; or its own one has another number now.
      vec2 seen = remembered(looks, px, true);
      isBehind = wasCovered || isUnlike(seen);
      isGone = isGone || float(longer) > 256.0 * kCoveredMover;
      if (!isBehind) {
        mover = numberOf(shares);
        looks = seen;
      }
    } else if (!isBehind) {
      looks = remembered(looks, px, !isOnMover && nearestMover(px, kOutline) > 0.1);
      isHidden = isMismatch(looks, (state & kHidden) != 0u);
      isOther = isOnMover && isUnlike(looks);
      if (isOnMover && moving < 0.35) {
        // It has joined the background, or has left the anchor behind.
        isOnMover = false;
        isOther = isOther || !isNewBackground(px);
        if (isReal(objectOf(id))) object = objectOf(id);
      } else if (wasCovered && !isOnMover) {
        isOther = false;
        asksBackground = isUnlike(looks);
      }
    }
    isOther = isOther || (asksBackground && isUnlikeBackground(looks, px));
    isGone = isGone || isOther;
  }
  // An anchor that has no point of its surface yet, or has come too far from it, takes the one that
  // is seen where it is.
  uint onSurface = isOnMover ? 0u : state & kOnSurface;
  if (object != objectOf(surface)) surface = idOf(object, 0u);
  if (onSurface == 0u && !isOnMover && isReal(object) && objectOf(id) == object) {
    surface = id;
    anchors[slot].barycentrics = texelFetch(barycentrics, pixel, 0).r;
    onSurface = kOnSurface;
  }
  anchors[slot].surface = surface;
  anchors[slot].appearance = packedLooks(looks);
  anchors[slot].px = px;
  uint covered = 0u;
  uint flags = (state & (kAlive | kDying)) | onSurface | (isHidden ? kHidden : 0u);
  if (isBehind) {
    covered = longer;
    isGone = isGone || (state & kDying) != 0u || isForgotten;
  }
  flags |= (isBehind ? kCovered : 0u) | (isOnMover ? stateOnMover(mover) : 0u);
  anchors[slot].state = isGone ? 0u : flags | source | (covered << kCoveredShift);
}
