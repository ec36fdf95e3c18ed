// Purpose: traces each anchor's stroke along the tensor field (thesis §4.4), both ways, and blends
//          it with its past: directions one by one, lengths, colour and existence with time
//          constants (§5.4), so that a stroke lives as long as its anchor.
//          A stroke stays on what it lies on: it ends where its label does (stroke_label.glsl), or
//          its depth makes a step.
// Defines: stroke_support.glsl's, for the lists of stroke_lists.glsl.
// Inputs:  anchors, slots of them; StrokeLists: those that are traced (stroke_lists.glsl);
//          stroke_walk.glsl's; background (marks::MotionLayers); background_activity.glsl's, but
//          with ON_MODELS; ids (ArFrame), ON_MODELS;
//          depthRange: the near and the far plane in metres, 0: no depth; focalPx: of
//          the full image, 0: not known; imageScale: the anchors', octaves; focus.glsl's and
//          fidelity.glsl's; layer: its
//          number and how many; the rest as in marks::StrokeRule.
// Outputs: strokes. One invocation per stroke of its list.
// Precision: highp.
#include "pipeline/gpu/shaders/hash.glsl"
#include "pipeline/marks/anchors/shaders/accent.glsl"
#include "pipeline/marks/anchors/shaders/anchor.glsl"
#include "pipeline/marks/shaders/fidelity.glsl"
#include "pipeline/marks/shaders/focus.glsl"
#include "pipeline/marks/movers/shaders/layer_blocks.glsl"
#include "pipeline/marks/strokes/shaders/stroke.glsl"
#include "pipeline/marks/strokes/shaders/stroke_history.glsl"
#include "pipeline/marks/strokes/shaders/stroke_lists.glsl"
#include "pipeline/marks/strokes/shaders/stroke_walk.glsl"
#include "pipeline/marks/movers/shaders/background_activity.glsl"
#include "pipeline/scene/render/shaders/object_id.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Anchors { Anchor anchors[]; };
layout(std430, binding = 1) buffer Strokes { Stroke strokes[]; };
layout(std430, binding = 2) readonly buffer StrokeLists { uint lists[]; };
uniform highp sampler2D background;
uniform highp usampler2D ids;
uniform bool anew;
uniform uint slots;
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
uniform float imageScale;
uniform float focalPx;
uniform vec2 layer;
uniform float width;

const int kList = isModel ? kOnModels : mayBeOnMover ? kMoversOnly : kWithLabels;
const float kFocusDetail = 1.0;  // how much more detail counts in a focus
const float kAccentDetail = 0.35;  // of what else is asked for, an accent needs

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

// The past's motion. Strokes on virtual objects have been carried by stroke_carry.comp.
vec4 turnOf(uint slot, bool isCarried) {
  return isCarried ? vec4(1.0, 0.0, 0.0, 1.0) : anchors[slot].jacobian;
}

// Stores the walked directions, `blends`: each one blended with its past. The stored directions are
// lines; the heading gives the first one its sign, and each one gives the next its sign.
void storeWays(uint slot, vec2 heading, bool isCarried, float stays, bool blends) {
  for (int i = 0; i < arms.x * arms.y; ++i) {
    vec2 way = ways[wayAt(i)];
    if (blends) {
      if (i == kArm) heading = -strokes[slot].ways[0];
      vec2 was = strokes[slot].ways[i];
      way = heldDirection(way, was, turnOf(slot, isCarried), stays);
      // The stretch of a surface is taken back with time, or strokes would grow with what comes nearer.
      if (isCarried) way *= mix(1.0, length(was), past.x);
      if (dot(way, heading) < 0.0) way = -way;
      heading = way;
    }
    strokes[slot].ways[i] = way;
  }
}

// Turns the stroke as its place has turned.
void turn(uint slot, vec4 jacobian) {
  if (jacobian == vec4(1.0, 0.0, 0.0, 1.0)) return;
  for (int i = 0; i < arms.x * arms.y; ++i) {
    vec2 way = strokes[slot].ways[i];
    strokes[slot].ways[i] = heldDirection(way, way, jacobian, 1.0);
  }
}

const float kShrinking = 4.0;  // times as fast as shapes change
const float kMoverShrinking = 20.0;

// Where fidelity is 1 (fidelity.glsl):
const float kFaithfulContrast = 1.0;  // so much more of the difference from what is around
const float kFaithfulReach = 1.5;     // widths, to what is around
const float kSettled = 0.02;          // of fidelity: less is no change

const float kModelHold = 0.25;  // of the rate at which shapes change elsewhere

// An arm that now covers other content shrinks faster than it would grow. One that was cut short
// by something that has gone grows, however long shapes are held. Where the background is dynamic,
// both would happen all the time.
float heldLength(float now, float was, float stays, bool isOnMover, float dynamic) {
  float shrinking = pow(past.x, isOnMover ? kMoverShrinking : kShrinking);
  float rate = was < 0.3 * now ? past.x : now < 0.6 * was ? min(stays, shrinking) : stays;
  return mix(now, was, mix(rate, stays, dynamic));
}

// How dynamic the background is where a stroke lies: the most of its middle, of places along both
// arms, and of both sides.
float activityAlong(vec2 px, vec2 heading) {
  float most = activityAt(px);
  vec2 arm = segment * heading;
  for (int i = 0; i < arms.x; ++i) {
    for (int k = 1; k <= 3; ++k) most = max(most, activityAt(px + 1.5 * float(k) * arm));
    most = max(most, activityAt(px + vec2(-arm.y, arm.x)));
    arm = -arm;
  }
  return most;
}

// From which difference on a stroke's place surely shows other content: its colour may be stressed.
float leastOther(uint slot) {
  float fidelity = isModel ? 0.0 : fidelityOf(strokes[slot].state);
  return otherColour.y * (1.0 + kFaithfulContrast * fidelity);
}

// Other content has come to rest in front of the stroke if it is new and of another colour.
bool isReplacedAt(vec2 px, vec3 colour) {
  const float kNewFrames = 3.5;  // fewer than what a moving camera remembers
  vec4 known = textureLod(background, inLayers(background, px), 0.0);
  bool isNew = known.a > 0.5 && known.a < kNewFrames && moverAt(px).r < 0.5;
  return isNew && apart(colour, known.rgb) > max(otherColour.y, 1.5 * colourThreshold);
}

// Adds a place of a stroke to what is before it: x: the largest label of a mover; y: 1 if a mover
// has joined the background there.
vec2 before(vec2 known, vec2 px, vec3 colour) {
  return max(known, vec2(moverAt(px).r, isReplacedAt(px, colour) ? 1.0 : 0.0));
}

// What is before a stroke of the background, or beside it.
vec2 whatIsBefore(uint slot, vec2 px) {
  vec2 found = vec2(0.0);
  vec2 at = px;
  vec3 colour = strokes[slot].colour;
  // Four corners around its anchor, then both arms.
  for (int i = -4; i < arms.x * arms.y; ++i) {
    if (i < 0) {
      at = px + segment * (2.0 * vec2(i & 1, i >> 1 & 1) - 1.0);
    } else {
      int step = i % kArm;
      at = (step == 0 ? px : at) + segment * strokes[slot].ways[i];
      if (float(step) >= strokes[slot].lengths[i / kArm]) continue;
    }
    found = before(found, at, colour);
  }
  return found;
}

// The part of its cell's target below this anchor: it is above 1 where there are more anchors than
// the target asks for. At its birth it is the part that anchor_spawn.comp has drawn.
float partOf(uint rank, float octaves) {
  return exp2(2.0 * (float(rank) / kRankUnits - kRankOrigin - octaves));
}

// Octaves of scale, as ranks have them, of a place.
float scaleAt(vec2 px) {
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

// A stroke that something is before or beside stays, or fades out, unchanged, unless it is of a
// colour that is not there. Whether it begins anew.
bool beginsAnew(uint slot, uint state, vec2 px, bool isBeside, bool hasJoined, bool isLeft) {
  bool isOnMover = mayBeOnMover && (state & kMover) != 0u;
  bool isBehind = (state & kCovered) != 0u;
  vec4 behind = textureLod(background, inLayers(background, px), 0.0);
  bool isReal = !isModel && !isVirtual(objectOf(anchors[slot].surface));
  bool isStale = isReal && !isOnMover && behind.a >= 1.0 &&
                 apart(strokes[slot].colour, behind.rgb) > leastOther(slot);
  bool isUnder = isBehind && isPatch(labelAt(px));
  isStale = isStale && !isUnder;
  if (isReal && !isUnder && (isBehind || isBeside) && hasJoined) {
    // It would be seen there, since nothing covers it any more.
    isStale = true;
    strokes[slot].exists = 0.0;  // also when that has become old
  }
  if (isUnder) turn(slot, turnOf(slot, isModel));
  if (isStale && !isBehind) return true;
  // Segments may have been labelled anew.
  uint label = labelOfStroke(strokes[slot].state);
  bool isFrozen = isReal && !isOnMover && isGround(label);
  if (isFrozen) {
    strokes[slot].state = (strokes[slot].state & ~kLabelMask) | labelOfGround(px, label, false);
  }
  strokes[slot].seen = isStale || isLeft ? 0.0 : strokes[slot].exists * anchors[slot].fade;
  return false;
}

// Whether the layer is painted at a place. `seen`: the detail there.
bool isWanted(uint slot, vec2 px, float seen, bool isResting, bool isNew) {
  float hash = unitOf(hashOf(anchors[slot].seed ^ 0x51u));
  // A stroke is wanted where the detail lies in its band; an existing one stays a little longer.
  float focused = focusStrength * focusAt(px);
  float detail = (1.0 + kFocusDetail * focused) * seen + detailSpread * (hash - 0.5);
  bool isAccent = !isModel && (strokes[slot].state & kAccent) != 0u;
  float leastDetail = detailBand.x * (isAccent ? kAccentDetail : 1.0);
  bool was = !isNew && (strokes[slot].state & kWanted) != 0u;
  float wider = was ? 1.0 - (isResting ? restSlack : slack) : isResting ? 1.0 + 0.5 * restSlack : 1.0;
  bool wanted = detail >= leastDetail * wider && detail <= detailBand.y / wider;
  if (focusStrength > 0.0) {
    float part = partOf(rankOf(anchors[slot].ageAndRank), scaleAt(px));
    // Patches of models are often smaller than broad strokes: only the finest layer thins out there.
    float least = isModel && layer.y > 2.0 ? (layer.y - 2.0) / (layer.y - 1.0) : 0.0;
    float fineness = max(finenessAt(px), least);
    // What finer strokes would hide is seen where they are not painted.
    wanted = wanted || (detail >= leastDetail * wider &&
                        !isAmong(layerShare(fineness, layer.x + 1.0, layer.y), part, !was));
    wanted = wanted && isAmong(layerShare(fineness, layer.x, layer.y), part, was);
  }
  return wanted;
}

// Marks a stroke that depicts something as narrow as itself: an accent, which is painted over the
// others of its layer, since those beside it would hide it.
void markAccent(uint slot, vec2 px, vec2 heading, bool isNew) {
  vec2 arm = beside * vec2(-heading.y, heading.x);
  vec3 left = vec3(0.0);
  vec3 right = vec3(0.0);
  for (int i = 0; i < arms.x; ++i) {
    left = right;
    right = unlikeAt(px + arm);
    arm = -arm;
  }
  float narrow = beside > 0.0 ? narrowness(left, right) : 0.0;
  bool was = !isNew && (strokes[slot].state & kAccent) != 0u;
  float least = isNew ? kNewAccent : was ? kRemainingAccent : kLaterAccent;
  strokes[slot].state = (strokes[slot].state & ~kAccent) | (narrow > least ? kAccent : 0u);
}

// Finds a stroke's fidelity, which follows that of its place.
void findFidelity(uint slot, vec2 px, bool isNew) {
  float there = fidelityAt(px);
  float fidelity = isNew ? there : mix(there, fidelityOf(strokes[slot].state), past.x);
  walks[gl_LocalInvocationIndex].fidelity = fidelity;
  walks[gl_LocalInvocationIndex].isChanging = abs(there - fidelity) > kSettled;
}

// What a stroke's fidelity adds to its colour: it stresses what differs from its surroundings, as
// portraits do.
vec3 stressOf(vec2 px, bool isOnMover) {
  vec3 own = walks[gl_LocalInvocationIndex].colour;
  vec3 unlike = vec3(0.0);  // sum of the differences from four places around
  int taps = fidelityHere() > 0.0 ? 4 : 0;
  for (int i = 0; i < taps; ++i) {
    float side = (i & 1) == 0 ? -kFaithfulReach : kFaithfulReach;
    vec2 at = (px + width * ((i & 2) == 0 ? vec2(side, 0.0) : vec2(0.0, side))) / fullSize;
    // Premultiplied: where all is another layer's, there is no difference.
    vec4 there = isOnMover ? textureLod(moverPaint, at, 0.0) : textureLod(paint, at, 0.0);
    unlike += there.a * own - there.rgb;
  }
  return 0.25 * kFaithfulContrast * fidelityHere() * unlike;
}

// What is read again, of anchors and strokes, is not kept in registers through the walk.
void main() {
  if (gl_GlobalInvocationID.x >= lists[kList + 3]) return;
  uint slot = lists[listedAt(kList, gl_GlobalInvocationID.x, lists[kOnModels + 3], slots)];
  uint state = anchors[slot].state;
  vec2 px = anchors[slot].px;
  bool isNew = anew || (state & kBorn) != 0u;
  bool isOnMover = mayBeOnMover && (state & kMover) != 0u;
  bool isBehind = (state & kCovered) != 0u;
  // A mover has left it behind. It would be drawn over the mover as long as it kept its label.
  bool isLeft = !isOnMover && isMoverLabel(labelOfStroke(strokes[slot].state));
  vec2 found = isNew || isOnMover || isLeft ? vec2(0.0) : whatIsBefore(slot, px);
  bool isBeside = found.x > 0.1;
  if (!isNew && ((state & kHidden) != 0u || isBehind || isBeside)) {
    // What is before it has other colours and directions.
    if (!beginsAnew(slot, state, px, isBeside, found.y > 0.0, isLeft)) return;
    isNew = true;
  }
  uint label = isOnMover ? labelOfMover(moverOf(state)) : 0u;
  if (!isModel && !isOnMover) label = labelOfGround(px, labelOfStroke(strokes[slot].state), isNew);
  if (isModel) {
    // That of its birth: its triangle does not change.
    label = isNew ? labelOfAnchor(px, anchors[slot].surface) : labelOfStroke(strokes[slot].state);
  }

  if (!isModel) findFidelity(slot, px, isNew);
  uint seed = anchors[slot].seed;
  float stray = wander * (unitOf(hashOf(seed ^ 0x77u)) + unitOf(hashOf(seed ^ 0x78u)) - 1.0);
  vec2 hand = vec2(cos(stray), sin(stray));
  Support on = supportOf(label, isOnMover, px);
  vec3 own = colourAt(px, on);
  float seen = detailAt(px, on);
  vec2 heading = directionAt(px, on);
  heading = vec2(hand.x * heading.x - hand.y * heading.y, hand.y * heading.x + hand.x * heading.y);
  if (!isNew) {
    // Keeps the previous orientation.
    vec4 jacobian = turnOf(slot, isModel);
    vec2 was = jacobian.xy * strokes[slot].ways[0].x + jacobian.zw * strokes[slot].ways[0].y;
    if (dot(was, heading) < 0.0) heading = -heading;
  }
  int me = int(gl_LocalInvocationIndex);
  walks[me].colour = own;
  walks[me].detail = seen * (1.0 + kFaithfulDetail * fidelityHere());
  walks[me].heading = heading;
  walks[me].hand = hand;
  walks[me].isNew = isNew;
  if (!isModel) markAccent(slot, px, heading, isNew);
  memoryBarrierShared();  // or compilers keep what they have just stored
  memoryBarrierBuffer();
  for (int side = 0; side < arms.x; ++side) {
    walk(side, px, on);
  }
  memoryBarrierShared();
  memoryBarrierBuffer();
  px = anchors[slot].px;
  seen = walks[gl_LocalInvocationIndex].detail;
  heading = walks[gl_LocalInvocationIndex].heading;
  isNew = walks[gl_LocalInvocationIndex].isNew;
  own = walks[gl_LocalInvocationIndex].colour;
  Arm ahead = walked[gl_LocalInvocationIndex];
  Arm behind = walked[kWalkers + int(gl_LocalInvocationIndex)];
  if (!bothWays) behind = Arm(vec3(0.0), 0.0, 0.0, 0.0);
  vec2 lengths = min(vec2(ahead.length, behind.length), stepsOfArm());
  float weight = ownWeight(layer.y - 1.0 - layer.x);
  vec3 colour = (weight * own + ahead.colour + behind.colour) /
                (weight + ahead.weight + behind.weight);
  if (!isModel) colour = clamp(colour + stressOf(px, isOnMover), 0.0, 1.0);

  // Before a standing camera, nothing but its content changes a stroke of the background.
  bool isResting = isStanding && !isNew && !isOnMover && !isModel;
  bool wanted = isWanted(slot, px, seen, isResting, isNew);
  float goal = wanted ? 1.0 : 0.0;
  // The past ends where the stroke stands on clearly other content.
  float restless = isResting ? 0.0 : smoothstep(flatDetail.x, flatDetail.y, seen);
  // A surface carries its strokes exactly: what changes is how its field is seen.
  float most = isModel ? kModelHold : 1.0;
  float hold = mix(min(1.0 / flatHold, most), most, restless);
  // Its lengths change with its fidelity.
  bool isChanging = !isModel && walks[gl_LocalInvocationIndex].isChanging;
  float stays = isOnMover || isChanging ? past.x : pow(past.x, hold);
  vec3 change = colour - strokes[slot].colour;
  vec2 otherHere = otherColour * (1.0 + kFaithfulContrast * fidelityHere());
  float activity = 0.0;
  if (!isModel && isResting) {
    activity = activityAlong(px, heading);
    otherHere += slackOf(activity);
  }
  float changed = isNew ? 0.0 : smoothstep(otherHere.x, otherHere.y, weightedLength(change));
  uint now = label | (wanted ? kWanted : 0u) | (isModel ? 0u : strokes[slot].state & kAccent);
  if (!isModel) {
    now = withGirth(now, girthOfFidelity(fidelityHere()));
  } else if (!isNew) {
    now = withGirth(now, mix(1.0, girthOf(strokes[slot].state), past.x));
  }
  strokes[slot].state = now;
  storeWays(slot, heading, isModel, stays, !isNew && changed < 0.5);
  float exists = goal;  // the anchor fades it in
  if (!isNew) {
    float was = strokes[slot].exists;
    exists = mix(goal, was, (1.0 - changed) * (goal > was ? past.z : past.w));
    if (abs(exists - goal) < 0.02) exists = goal;
    float dynamic = dynamicShare(activity);
    lengths = vec2(heldLength(lengths.x, strokes[slot].lengths.x, stays, isOnMover, dynamic),
                   heldLength(lengths.y, strokes[slot].lengths.y, stays, isOnMover, dynamic));
    float held = (1.0 - past.y) * min(1.0, maxColour / max((1.0 - past.y) * length(change), 1e-6));
    colour = strokes[slot].colour + change * mix(held, 1.0, changed);
  }
  strokes[slot].lengths = lengths;
  strokes[slot].exists = exists;
  strokes[slot].colour = colour;
  strokes[slot].seen = exists * anchors[slot].fade;
}
