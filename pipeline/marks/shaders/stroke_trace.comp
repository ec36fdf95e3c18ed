// Purpose: traces each anchor's stroke along the tensor field (thesis §4.4), both ways, and blends
//          it with its past: directions one by one, lengths, colour and existence with time
//          constants (§5.4), so that a stroke lives as long as its anchor.
//          A stroke stays on what it lies on: it ends where its label does (stroke_label.glsl), or
//          its depth makes a step.
// Inputs:  anchors; field: tensors to follow, detailField: tensors with the detail; modelField,
//          modelDetailField, moverField: those of virtual objects and of movers;
//          mover_labels.glsl's and mover_motion.glsl's; background (marks::MotionLayers); paint,
//          modelPaint, moverPaint: the reduced images of the background, of models and of movers;
//          finePaint, fineGround: the finest of models and of the background; paintTexel: the width
//          of modelPaint's texels, px of the full image; labels if hasLabels: of pixels, in the
//          lower bits of ArFrame::forms or of StrokeSet::update()'s borders, which labelMask tells;
//          hasSegments: they have segments' labels, too; ids and depth (ArFrame) if
//          hasObjects, within objectBounds; depthRange: the near and the far plane in metres, 0: no depth; focalPx: of
//          the full image, 0: not known; imageScale: the anchors', octaves; focus.glsl's; layer: its
//          number and how many; the rest as in
//          marks::StrokeRule.
// Outputs: strokes. One invocation per anchor.
// Precision: highp.
#include "pipeline/gpu/shaders/hash.glsl"
#include "pipeline/marks/shaders/anchor.glsl"
#include "pipeline/marks/shaders/colour_difference.glsl"
#include "pipeline/marks/shaders/focus.glsl"
#include "pipeline/marks/shaders/stroke.glsl"
#include "pipeline/marks/shaders/stroke_history.glsl"
#include "pipeline/marks/shaders/stroke_border.glsl"
#include "pipeline/scene/render/shaders/depth_step.glsl"
#include "pipeline/scene/render/shaders/object_id.glsl"
#include "pipeline/scene/render/shaders/surface_form.glsl"
#include "pipeline/marks/shaders/layer_blocks.glsl"
#include "pipeline/marks/shaders/mover_labels.glsl"
#include "pipeline/marks/shaders/mover_motion.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Anchors { Anchor anchors[]; };
layout(std430, binding = 1) buffer Strokes { Stroke strokes[]; };
uniform highp sampler2D field;
uniform highp sampler2D detailField;
uniform highp sampler2D modelField;
uniform highp sampler2D modelDetailField;
uniform highp sampler2D moverField;
uniform highp sampler2D background;
uniform highp sampler2D paint;
uniform highp sampler2D modelPaint;
uniform highp sampler2D moverPaint;
uniform highp sampler2D finePaint;
uniform highp sampler2D fineGround;
uniform float paintTexel;
uniform highp usampler2D ids;
uniform highp usampler2D labels;
uniform uint labelMask;
uniform bool hasLabels;
uniform bool hasSegments;
uniform highp sampler2D depth;
uniform bool hasObjects;
uniform vec4 objectBounds;
uniform bool anew;
uniform vec2 fullSize;
uniform vec2 pixelsOfFull;
uniform vec2 fieldScale;  // px of the full image to texture coordinates of the fields
uniform vec2 detailScale;
uniform vec2 moverScale;
uniform uint slots;
uniform float segment;       // px
uniform float steps;         // at most kArm
uniform float minSteps;
uniform float colourThreshold;
uniform float cutOff;        // cosine
uniform vec2 detailBand;  // range of detail in which the layer is painted
uniform float modelDetail;  // factor of the detail on virtual surfaces
uniform float detailSpread;  // random spread of the band among anchors
uniform float slack;  // hysteresis: the part by which the band is wider for existing strokes
uniform bool bothWays;  // false: only ahead, as in the thesis
uniform float wander;  // rad: the random deviation of a stroke from the field
uniform vec4 past;  // the past's shares: shape, colour, existence rising, existence falling
uniform float maxColour;  // the largest change of colour in this frame
uniform vec2 otherColour;
uniform vec2 flatDetail;
uniform float flatHold;
uniform bool isStanding;  // the camera
uniform float restSlack;
uniform float looseness;
uniform bool clips;  // strokes end at the borders of models, patches and movers
uniform vec2 loosePx;  // a frame
uniform float imageScale;
uniform float focalPx;
uniform vec2 layer;

const vec2 kUpright = vec2(1.0, 0.0);  // a tensor: strokes of movers without any edge

const float kFocusDetail = 1.0;  // how much more detail counts in a focus

// What the stroke is painted on.
struct Support {
  bool isModel;
  uint label;
  bool isMixed;  // the reduced image mixes its colours with those of what is beside it
  bool isOnMover;
  float looseness;  // how much looser it is painted, in [0, 1]
  vec2 along;       // a tensor, of strokes along the mover's motion
};

ivec2 pixelAt(vec2 px) {
  return clamp(ivec2(floor(px * pixelsOfFull)), ivec2(0), textureSize(labels, 0) - 1);
}

uint labelsAt(vec2 px) { return hasLabels ? texelFetch(labels, pixelAt(px), 0).r : 0u; }
// The label of a surface; movers are told by mover_labels.glsl.
uint labelOfSurface(uint texel) {
  uint label = texel & labelMask;
  return label == kMoverLabel ? 0u : label;
}
uint labelAt(vec2 px) { return labelOfSurface(labelsAt(px)); }

// Whether a step from one pixel of `labels` to the next goes over a joint of a smooth surface.
bool isOverJoint(uint from, uint to) {
  return hasSegments ? isOpen(to) && otherOf(to) == ownOf(from) : isOneJoint(from, to);
}

// The label of the anchor's triangle: that of its pixel, or of the one beside it that shows the
// triangle.
uint labelOfAnchor(vec2 px, uint surface) {
  ivec2 middle = pixelAt(px);
  ivec2 last = textureSize(ids, 0) - 1;
  ivec2 found = middle;
  for (int i = 0; i < 9; ++i) {
    ivec2 at = clamp(middle + ivec2(i % 3, i / 3) - 1, ivec2(0), last);
    if (texelFetch(ids, at, 0).r == surface && (i == 4 || found == middle)) found = at;
  }
  if (texelFetch(ids, middle, 0).r == surface) found = middle;
  return texelFetch(labels, found, 0).r & labelMask;
}

// The label of a stroke of the background: that of its anchor's pixel, or, as before, of one that is
// near, so that an anchor on a border does not change sides.
uint labelOfGround(vec2 px, uint before, bool isNew) {
  const float kNear = 3.0;  // px
  if (!hasSegments) return 0u;
  uint now = labelAt(px);
  if (!isGround(now)) return isNew || !isGround(before) ? 0u : before;
  if (isNew || now == before || !isGround(before)) return now;
  for (int i = 0; i < 4; ++i) {
    float side = (i & 1) == 0 ? -kNear : kNear;
    if (labelAt(px + ((i & 2) == 0 ? vec2(side, 0.0) : vec2(0.0, side))) == before) return before;
  }
  return now;
}

// Whether another patch is within a texel of the reduced image, at a third of it, two or all.
bool isMixedAt(vec2 px, uint label) {
  for (int i = 0; i < 12; ++i) {
    float reach = paintTexel * float(1 + i / 4) / 3.0;
    float side = (i & 1) == 0 ? -reach : reach;
    vec2 arm = (i & 2) == 0 ? vec2(side, 0.0) : vec2(0.0, side);
    if (!mayCover(label, labelAt(px + arm))) return true;
  }
  return false;
}

Support supportOf(bool isModel, uint label, bool isOnMover, vec2 px) {
  Support on = Support(isModel, label, false, isOnMover, 0.0, kUpright);
  bool hasOthers = isModel || (hasSegments && !isOnMover && label != 0u);
  on.isMixed = clips && hasOthers && isMixedAt(px, label);
  vec2 moved;
  if (!isOnMover || looseness <= 0.0 || !findMoverMotion(px, moved)) return on;
  on.looseness = looseness * smoothstep(loosePx.x, max(loosePx.y, loosePx.x + 1e-3), length(moved));
  on.along = vec2(moved.y * moved.y - moved.x * moved.x, -2.0 * moved.x * moved.y) /
             max(dot(moved, moved), 1e-6);
  return on;
}

vec2 directionAt(vec2 px, Support on) {
  vec2 tensor;
  if (on.isModel) {
    tensor = textureLod(modelField, px * fieldScale, 0.0).xy;
  } else if (on.isOnMover) {
    tensor = textureLod(moverField, px * moverScale, 0.0).xy;
    tensor = dot(tensor, tensor) > 1e-3 ? tensor : kUpright;
  } else {
    tensor = textureLod(field, px * fieldScale, 0.0).xy;
  }
  tensor *= inversesqrt(max(dot(tensor, tensor), 1e-12));
  tensor = mix(tensor, on.along, 0.8 * on.looseness);
  tensor *= inversesqrt(max(dot(tensor, tensor), 1e-12));
  // Half the angle by square roots; the stroke runs across the gradient.
  vec2 gradient = vec2(sqrt(max(0.0, 0.5 + 0.5 * tensor.x)), sqrt(max(0.0, 0.5 - 0.5 * tensor.x)));
  if (tensor.y < 0.0) gradient.y = -gradient.y;
  return vec2(-gradient.y, gradient.x);
}

// The colour of a patch or segment within a texel of the reduced image.
vec4 ownColour(vec2 px, Support on) {
  vec4 sum = vec4(0.0);
  for (int i = 0; i < 9; ++i) {
    vec2 at = px + 0.4 * paintTexel * (vec2(i % 3, i / 3) - 1.0);
    if (!mayCover(on.label, labelAt(at))) continue;
    sum += on.isModel ? textureLod(finePaint, at / fullSize, 0.0)
                      : textureLod(fineGround, at / fullSize, 0.0);
  }
  return sum;
}

// The colour of the stroke's own patch or layer, if any of it is near.
vec3 colourAt(vec2 px, Support on) {
  const float kOthers = 1e-3;  // weight of the other layer
  vec2 at = px / fullSize;
  if (on.isModel) {
    vec4 seen = on.isMixed ? ownColour(px, on) : vec4(0.0);
    if (seen.a <= 0.0) seen = textureLod(modelPaint, at, 0.0);
    return seen.rgb / max(seen.a, 1e-4);
  }
  vec4 ground = on.isMixed ? ownColour(px, on) : vec4(0.0);
  if (ground.a <= 0.0) ground = textureLod(paint, at, 0.0);
  vec4 mover = textureLod(moverPaint, at, 0.0);
  vec4 seen = on.isOnMover ? mover + kOthers * ground : ground + kOthers * mover;
  return seen.rgb / max(seen.a, 1e-4);
}

float depthAt(vec2 px) { return texelFetch(depth, pixelAt(px), 0).r; }

// The part of a segment that lies on its patch, in [0, 1]; a step of a pixel at a time; segments of
// the image are never as narrow as patches. Where trunk and limb meet on a smooth surface, it may go
// on for kOverJoint; `strayed`: the px so far, of the whole arm.
float partOnPatch(vec2 from, vec2 to, Support on, inout float strayed) {
  float stride = hasObjects ? 1.0 : 3.0;
  float count = max(1.0, ceil(distance(from, to) * max(pixelsOfFull.x, pixelsOfFull.y) / stride));
  vec2 pace = (to - from) / count;
  uint label = on.isOnMover ? 0u : on.label;  // models alone have labels in the image
  if (!on.isModel && !hasSegments) return 1.0;
  bool isDeep = on.isModel && depthRange.y > 0.0;
  float before = isDeep ? depthAt(from - pace) : 0.0;
  float here = isDeep ? depthAt(from) : 0.0;
  uint last = labelsAt(from);
  for (float i = 1.0; i <= count; i += 1.0) {
    vec2 at = from + i * pace;
    uint texel = labelsAt(at);
    bool isUnder = !on.isModel && isPatch(labelOfSurface(texel));
    if (!isUnder && !mayCover(label, labelOfSurface(texel))) {
      bool isSame = labelOfSurface(texel) == labelOfSurface(last);
      bool goesOn = isDeep && (isSame || isOverJoint(last, texel));
      strayed += length(pace);
      if (!goesOn || strayed > kOverJoint) {
        bool isEarly = stride > 1.0 && !mayCover(label, labelAt(at - 0.5 * pace));
        return max(0.0, (i - (isEarly ? 0.75 : stride > 1.0 ? 0.25 : 0.5)) / count);
      }
    }
    last = texel;
    if (!isDeep) continue;
    float next = depthAt(at);
    if (isDepthStep(before - 2.0 * here + next, here)) return max(0.0, (i - 1.5) / count);
    before = here;
    here = next;
  }
  return 1.0;
}

// The anchor's place counts more than the rest of the stroke, or small lights would vanish.
const float kOwnWeight = 3.0;

struct Arm {
  vec2 directions[kArm];
  float length;
  vec3 colour;  // sum over its visible part
  float weight;
};

float detailAt(vec2 px, Support on) {
  const float kLooseDetail = 0.6;
  if (on.isModel) {
    return modelDetail * textureLod(modelDetailField, px * detailScale, 0.0).w;
  }
  float detail = on.isOnMover ? textureLod(moverField, px * moverScale, 0.0).w
                              : textureLod(detailField, px * detailScale, 0.0).w;
  return mix(1.0, kLooseDetail, on.looseness) * detail;
}

// Whether an arm may come to labels other than the background's 0.
bool reachesLabels(vec2 px) {
  if (hasSegments || !hasLabels) return hasLabels;
  vec2 reach = (segment * float(kArm) + 2.0) * pixelsOfFull;
  vec2 at = px * pixelsOfFull;
  return all(greaterThanEqual(at, objectBounds.xy - reach)) &&
         all(lessThanEqual(at, objectBounds.zw + reach));
}

const float kBehind = 0.025;  // of the image's width: so far strokes go on behind models

Arm walk(vec2 from, vec2 heading, vec2 hand, vec3 own, Support on) {
  bool mayLeave = clips && reachesLabels(from);
  // The camera image goes on behind a model: strokes do, too, and are clipped where it is drawn. They
  // do not go far: nothing is known of what is there.
  bool goesBehind = mayLeave && !on.isModel;
  float left = kBehind * fullSize.x;
  Arm arm;
  arm.length = steps;
  arm.colour = vec3(0.0);
  arm.weight = 0.0;
  bool goesOn = true;
  float before = 0.0;
  vec2 at = from;
  float strayed = 0.0;
  for (int i = 0; i < kArm; ++i) {
    vec2 direction = directionAt(at + 0.5 * segment * heading, on);
    direction = vec2(hand.x * direction.x - hand.y * direction.y,
                     hand.y * direction.x + hand.x * direction.y);
    float along = dot(direction, heading);
    if (along < 0.0) direction = -direction;
    if (goesOn && i > 0 && abs(along) < cutOff) {
      goesOn = false;
      arm.length = min(arm.length, float(i));
    }
    arm.directions[i] = direction;
    if (goesOn && mayLeave) {
      // An arm ends where another surface begins.
      float part = partOnPatch(at, at + segment * direction, on, strayed);
      if (part < 1.0) {
        arm.length = min(arm.length, float(i) + part);
        goesOn = false;
      }
    }
    at += segment * direction;
    if (goesBehind && goesOn && isPatch(labelAt(at))) {
      if (left < segment) arm.length = min(arm.length, float(i) + left / segment);
      goesOn = left >= segment;
      left -= segment;
      heading = direction;
      continue;
    }
    vec3 there = goesOn ? colourAt(at, on) : own;
    float difference = apart(there, own);
    if (goesOn && clips && (moverAt(at).r > 0.5) != on.isOnMover) {
      // It does not cross a mover's border.
      bool isEarly = (moverAt(at - 0.5 * segment * direction).r > 0.5) != on.isOnMover;
      arm.length = min(arm.length, float(i) + (isEarly ? 0.25 : 0.75));
      goesOn = false;
    }
    if (goesOn && detailAt(at, on) < 0.4 * detailBand.x) {
      // A finer layer's stroke does not enter regions of coarser layers.
      arm.length = min(arm.length, max(float(i) + 0.5, minSteps));
      goesOn = false;
    }
    if (goesOn && difference > colourThreshold) {
      float part = clamp((colourThreshold - before) / max(difference - before, 1e-4), 0.0, 1.0);
      arm.length = min(arm.length, max(float(i) + part, minSteps));
      goesOn = false;
    }
    if (goesOn && float(i) < steps) {
      float weight = 1.0 - 0.7 * difference / colourThreshold;
      arm.colour += weight * there;
      arm.weight += weight;
    }
    before = difference;
    heading = direction;
  }
  return arm;
}

// An arm blended with its past. The stored directions are lines; the heading gives the first one
// its sign, and each one gives the next its sign.
vec2[kArm] heldArm(vec2 now[kArm], vec4 was[2], vec2 heading, vec4 jacobian, float stays, bool relaxes) {
  vec2 before[kArm] = vec2[kArm](was[0].xy, was[0].zw, was[1].xy, was[1].zw);
  vec2 held[kArm];
  for (int i = 0; i < kArm; ++i) {
    held[i] = heldDirection(now[i], before[i], jacobian, stays);
    // The stretch of a surface is taken back with time, or strokes would grow with what comes nearer.
    if (relaxes) held[i] *= mix(1.0, length(before[i]), past.x);
    if (dot(held[i], heading) < 0.0) held[i] = -held[i];
    heading = held[i];
  }
  return held;
}

vec2 turned(vec2 direction, vec4 jacobian) { return heldDirection(direction, direction, jacobian, 1.0); }

// The stroke after its place has turned.
Stroke turned(Stroke stroke, vec4 jacobian) {
  if (jacobian == vec4(1.0, 0.0, 0.0, 1.0)) return stroke;
  for (int i = 0; i < 2; ++i) {
    stroke.ahead[i] = vec4(turned(stroke.ahead[i].xy, jacobian), turned(stroke.ahead[i].zw, jacobian));
    stroke.behind[i] =
        vec4(turned(stroke.behind[i].xy, jacobian), turned(stroke.behind[i].zw, jacobian));
  }
  return stroke;
}

const float kShrinking = 4.0;  // times as fast as shapes change
const float kMoverShrinking = 20.0;

// An arm that now covers other content shrinks faster than it would grow. One that was cut short
// by something that has gone grows, however long shapes are held.
float heldLength(float now, float was, float stays, bool isOnMover) {
  float shrinking = pow(past.x, isOnMover ? kMoverShrinking : kShrinking);
  float rate = was < 0.3 * now ? past.x : now < 0.6 * was ? min(stays, shrinking) : stays;
  return mix(now, was, rate);
}

// Whether a mover is at the stroke or beside it.
bool reachesMover(vec2 px, Stroke stroke) {
  float most = 0.0;
  for (int i = 0; i < 4; ++i) {
    most = max(most, moverAt(px + segment * (2.0 * vec2(i & 1, i >> 1) - 1.0)).r);
  }
  vec2 ahead = px;
  vec2 behind = px;
  for (int i = 0; i < kArm; ++i) {
    vec4 two = stroke.ahead[i >> 1];
    ahead += segment * ((i & 1) == 0 ? two.xy : two.zw);
    two = stroke.behind[i >> 1];
    behind += segment * ((i & 1) == 0 ? two.xy : two.zw);
    if (float(i) < stroke.lengths.x) most = max(most, moverAt(ahead).r);
    if (float(i) < stroke.lengths.y) most = max(most, moverAt(behind).r);
  }
  return most > 0.1;
}

// The part of its cell's target below this anchor: it is above 1 where there are more anchors than
// the target asks for. At its birth it is the part that anchor_spawn.comp has drawn.
float partOf(uint rank, float octaves) {
  return exp2(2.0 * (float(rank) / kRankUnits - kRankOrigin - octaves));
}

// Octaves of scale, as ranks have them, of a place.
float scaleAt(vec2 px, bool isModel) {
  if (!isModel || depthRange.y <= 0.0 || focalPx <= 0.0) return imageScale;
  return log2(focalPx / max(metresOf(depthAt(px)), 1e-3));
}

// Whether the anchor is among the share of the layer that is painted. The largest shares include
// anchors beyond the target.
bool isAmong(float share, float part, bool was) {
  const float kSlack = 0.05;
  const float kMost = 0.75;
  if (was) share += min(kSlack, 0.5 * share);
  return share >= 1.0 || part < share + 12.0 * max(share - kMost, 0.0);
}

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= slots) return;
  uint state = anchors[slot].state;
  if (!isAlive(state)) {
    strokes[slot].seen = 0.0;
    return;
  }
  vec2 px = anchors[slot].px;
  // Strokes on virtual objects have been carried by stroke_carry.comp.
  bool isCarried = hasObjects && isVirtual(objectOf(anchors[slot].surface));
  vec4 jacobian = isCarried ? vec4(1.0, 0.0, 0.0, 1.0) : anchors[slot].jacobian;
  uint seed = anchors[slot].seed;
  bool isNew = anew || (state & kBorn) != 0u;
  Stroke old = strokes[slot];
  bool isOnMover = (state & kMover) != 0u;
  bool isBehind = (state & kCovered) != 0u;
  // A mover has left it behind. It would be drawn over the mover as long as it kept its label.
  bool isLeft = !isOnMover && labelOfStroke(old.state) == kMoverLabel;
  bool isBeside = !isNew && !isOnMover && !isLeft && reachesMover(px, old);
  if (!isNew && ((state & kHidden) != 0u || isBehind || isBeside)) {
    // What is before it has other colours and directions: the stroke stays, or fades out,
    // unchanged, unless it is of a colour that is not there.
    vec4 behind = textureLod(background, inLayers(background, px), 0.0);
    bool isReal = !isVirtual(objectOf(anchors[slot].surface));
    bool isStale = isReal && !isOnMover && behind.a >= 1.0 &&
                   apart(old.colour, behind.rgb) > otherColour.y;
    bool isUnder = isBehind && isPatch(labelAt(px));
    isStale = isStale && !isUnder;
    if (isUnder) old = turned(old, jacobian);
    if (!isStale || isBehind) {
      // Segments may have been labelled anew.
      bool isFrozen = isReal && !isOnMover && isGround(labelOfStroke(old.state));
      if (isFrozen) old.state = (old.state & ~kLabelMask) |
                                labelOfGround(px, labelOfStroke(old.state), false);
      old.seen = isStale || isLeft ? 0.0 : old.exists * anchors[slot].fade;
      strokes[slot] = old;
      return;
    }
    isNew = true;
  }
  bool isModel = hasObjects && isVirtual(objectOf(anchors[slot].surface));
  uint label = isOnMover ? kMoverLabel : 0u;
  if (!isModel && !isOnMover) label = labelOfGround(px, labelOfStroke(old.state), isNew);
  if (isModel) {
    // That of its birth: its triangle does not change.
    label = isNew ? labelOfAnchor(px, anchors[slot].surface) : labelOfStroke(old.state);
  }

  float hash = unitOf(hashOf(seed ^ 0x51u));
  float stray = wander * (unitOf(hashOf(seed ^ 0x77u)) + unitOf(hashOf(seed ^ 0x78u)) - 1.0);
  vec2 hand = vec2(cos(stray), sin(stray));
  Support on = supportOf(isModel, label, isOnMover, px);
  vec3 own = colourAt(px, on);
  vec2 heading = directionAt(px, on);
  heading = vec2(hand.x * heading.x - hand.y * heading.y, hand.y * heading.x + hand.x * heading.y);
  if (!isNew) {
    // Keeps the previous orientation.
    vec2 was = jacobian.xy * old.ahead[0].x + jacobian.zw * old.ahead[0].y;
    if (dot(was, heading) < 0.0) heading = -heading;
  }
  Arm ahead = walk(px, heading, hand, own, on);
  Arm behind = walk(px, -heading, hand, own, on);
  if (!bothWays) {
    behind.length = 0.0;
    behind.colour = vec3(0.0);
    behind.weight = 0.0;
  }
  vec3 colour = (kOwnWeight * own + ahead.colour + behind.colour) /
                (kOwnWeight + ahead.weight + behind.weight);

  // A stroke is wanted where the detail lies in its band; an existing one stays a little longer.
  float seen = detailAt(px, on);
  float focused = focusStrength * focusAt(px);
  float detail = (1.0 + kFocusDetail * focused) * seen + detailSpread * (hash - 0.5);
  // Before a standing camera, nothing but its content changes a stroke of the background.
  bool isResting = isStanding && !isNew && !isOnMover && !isModel;
  bool was = !isNew && (old.state & kWanted) != 0u;
  float wider = was ? 1.0 - (isResting ? restSlack : slack) : isResting ? 1.0 + 0.5 * restSlack : 1.0;
  bool wanted = detail >= detailBand.x * wider && detail <= detailBand.y / wider;
  if (focusStrength > 0.0) {
    float part = partOf(rankOf(anchors[slot].ageAndRank), scaleAt(px, isModel));
    // Patches of models are often smaller than broad strokes: only the finest layer thins out there.
    float least = isModel && layer.y > 2.0 ? (layer.y - 2.0) / (layer.y - 1.0) : 0.0;
    float fineness = max(finenessAt(px), least);
    // What finer strokes would hide is seen where they are not painted.
    wanted = wanted || (detail >= detailBand.x * wider &&
                        !isAmong(layerShare(fineness, layer.x + 1.0, layer.y), part, !was));
    wanted = wanted && isAmong(layerShare(fineness, layer.x, layer.y), part, was);
  }
  float goal = wanted ? 1.0 : 0.0;

  // The past ends where the stroke stands on clearly other content.
  float restless = isResting ? 0.0 : smoothstep(flatDetail.x, flatDetail.y, seen);
  float stays = isOnMover ? past.x : pow(past.x, mix(1.0 / flatHold, 1.0, restless));
  float changed = isNew ? 0.0 : smoothstep(otherColour.x, otherColour.y, apart(colour, old.colour));
  Stroke made;
  made.state = label | (wanted ? kWanted : 0u);
  if (isCarried && !isNew) {
    made.state = withGirth(made.state, mix(1.0, girthOf(old.state), past.x));
  }
  if (!isNew) {
    if (changed < 0.5) {
      ahead.directions = heldArm(ahead.directions, old.ahead, heading, jacobian, stays, isCarried);
      behind.directions =
          heldArm(behind.directions, old.behind, -ahead.directions[0], jacobian, stays,
                  isCarried);
    }
  }
  made.ahead[0] = vec4(ahead.directions[0], ahead.directions[1]);
  made.ahead[1] = vec4(ahead.directions[2], ahead.directions[3]);
  made.behind[0] = vec4(behind.directions[0], behind.directions[1]);
  made.behind[1] = vec4(behind.directions[2], behind.directions[3]);
  if (isNew) {
    made.lengths = vec2(ahead.length, behind.length);
    made.exists = goal;  // the anchor fades it in
    made.colour = colour;
  } else {
    made.lengths = vec2(heldLength(ahead.length, old.lengths.x, stays, isOnMover),
                        heldLength(behind.length, old.lengths.y, stays, isOnMover));
    made.exists = mix(goal, old.exists, (1.0 - changed) * (goal > old.exists ? past.z : past.w));
    if (abs(made.exists - goal) < 0.02) made.exists = goal;
    vec3 change = colour - old.colour;
    float held = (1.0 - past.y) * min(1.0, maxColour / max((1.0 - past.y) * length(change), 1e-6));
    made.colour = old.colour + change * mix(held, 1.0, changed);
  }
  made.seen = made.exists * anchors[slot].fade;
  strokes[slot] = made;
}
