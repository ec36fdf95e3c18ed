// Purpose: walks one arm of a stroke along the field (thesis §4.4) until it turns too sharply,
//          leaves what it lies on, or its colour or detail is no longer the stroke's.
// Defines: stroke_support.glsl's.
// Inputs:  stroke_support.glsl's; depth (ArFrame), ON_MODELS; objectBounds; segment: the
//          length of a step, px of the full image; steps: of an arm, at most kArm; minSteps: of one
//          that detail or colour ends; colourThreshold; cutOff: cosine of the sharpest turn;
//          beside: from a stroke's middle to what is beside it, px of the full image; detailBand: the
//          detail in which the layer is painted; arms: 2, of kArm steps each, a uniform, so that
//          compilers keep the loops; a group of kWalkers invocations.
// Outputs: functions; walked: an invocation's arms, ways: their directions. Precision: highp.
#include "pipeline/marks/shaders/colour_difference.glsl"
#include "pipeline/marks/strokes/shaders/stroke.glsl"
#include "pipeline/marks/strokes/shaders/stroke_reach.glsl"
#include "pipeline/marks/strokes/shaders/stroke_support.glsl"
#include "pipeline/scene/render/shaders/depth_step.glsl"
uniform highp sampler2D depth;
uniform vec4 objectBounds;
uniform float segment;       // px
uniform float steps;         // at most kArm
uniform float minSteps;
uniform float colourThreshold;
uniform float cutOff;        // cosine
uniform vec2 detailBand;  // range of detail in which the layer is painted
uniform ivec2 arms;
uniform float beside;  // px; 0: what is beside a stroke is not looked at

float depthAt(vec2 px) { return texelFetch(depth, pixelAt(px), 0).r; }

// Pixels from one look at labels to the next; segments of the image are never as narrow as patches.
const float kStride = isModel ? 1.0 : 3.0;

// How many looks a step of the walk takes, and how far it is from one to the next.
float looksOfStep() {
  return max(1.0, ceil(segment * max(pixelsOfFull.x, pixelsOfFull.y) / kStride));
}
float pace() { return segment / looksOfStep(); }

// The place of a look, of a step of the walk that ends at `to`.
vec2 placeOf(float look, vec2 to, vec2 heading) {
  return to - (looksOfStep() - look) * pace() * heading;
}

// The look, from 1 on, at which a step leaves its patch, or one more than there are; where trunk and
// limb meet on a smooth surface, it may go on for kOverJoint. `strayed`: the px so far, of the whole
// arm.
float leavesPatchAt(vec2 to, vec2 heading, Support on, inout float strayed) {
  uint last = labelsAt(placeOf(0.0, to, heading));
  float i = 1.0;
  for (; i <= looksOfStep(); i += 1.0) {
    uint texel = labelsAt(placeOf(i, to, heading));
    bool isUnder = !isModel && isPatch(labelOfSurface(texel));
    if (!isUnder && !mayCover(on.label, labelOfSurface(texel))) {
      bool isSame = labelOfSurface(texel) == labelOfSurface(last);
      bool goesOn = isModel && depthRange.y > 0.0 && (isSame || isOverJoint(last, texel));
      strayed += pace();
      if (!goesOn || strayed > kOverJoint) break;
    }
    last = texel;
  }
  return i;
}

// The look before `end` at which the depth makes a step, or `end`.
float leavesDepthAt(vec2 to, vec2 heading, float end) {
  float before = depthAt(placeOf(-1.0, to, heading));
  float here = depthAt(placeOf(0.0, to, heading));
  float i = 1.0;
  for (; i < end; i += 1.0) {
    float next = depthAt(placeOf(i, to, heading));
    if (isDepthStep(before - 2.0 * here + next, here)) break;
    before = here;
    here = next;
  }
  return i;
}

// The part of a step of the walk that lies on its patch, in [0, 1].
float partOnPatch(vec2 to, vec2 heading, Support on, inout float strayed) {
  if (!isModel && !hasSegments) return 1.0;
  float end = leavesPatchAt(to, heading, on, strayed);
  if (isModel && depthRange.y > 0.0) {
    float i = leavesDepthAt(to, heading, end);
    if (i < end) return max(0.0, (i - 1.5) / looksOfStep());
  }
  if (end > looksOfStep()) return 1.0;
  if (isModel) return max(0.0, (end - 0.5) / looksOfStep());
  bool isEarly = !mayCover(on.label, labelAt(placeOf(end - 0.5, to, heading)));
  return max(0.0, (end - (isEarly ? 0.75 : 0.25)) / looksOfStep());
}

// The anchor's place counts more than the rest of a fine stroke, or small lights would vanish. Coarser
// ones, which lie under these, go beyond what they begin on: their ends would be seen in a colour that is
// not there.
float ownWeight(float layersAbove) { return 3.0 * exp2(-2.0 * layersAbove); }

struct Arm {
  vec3 colour;  // sum over its visible part
  float weight;
  float length;
  float difference;  // of the last step's colour
};

// What a walk starts from: the colour and the detail at the anchor, the direction there, and by how
// much the stroke deviates from the field; its fidelity; and whether nothing of it is kept.
struct Walk {
  vec3 colour;
  float detail;
  vec2 heading;
  vec2 hand;
  float fidelity;
  bool isNew;
  bool isChanging;  // the fidelity
};

// In registers, these would leave none to the walk.
shared Walk walks[kWalkers];
shared Arm walked[2 * kWalkers];
shared vec2 ways[kWalkers * 2 * kArm];
int wayAt(int step) { return step * kWalkers + int(gl_LocalInvocationIndex); }

// Whether an arm may come to labels other than the background's 0.
bool reachesLabels(vec2 px) {
  if (hasSegments || !hasLabels) return hasLabels;
  return reachesObjects(px, segment, objectBounds, pixelsOfFull);
}

// The difference of the background's colour from the stroke's. Strokes on movers ask, too: where the
// reduced images of layers are apart, it is 0 there.
vec3 unlikeAt(vec2 px) {
  vec4 there = textureLod(paint, px / fullSize, 0.0);
  return there.rgb - there.a * walks[gl_LocalInvocationIndex].colour;
}

// The heading of a step that leans away from other colours on one side of it, so that a stroke follows
// what is as narrow as itself, and does not run over an edge that the field only knows roughly.
vec2 steered(vec2 at, vec2 heading) {
  const float kReach = 0.45;  // of `beside`
  const float kLean = 4.0;  // of the reach, for a difference of colour of 1
  const float kMost = 0.35;  // of the step
  float reach = kReach * beside;
  float lean = 0.0;
  for (int i = 0; i < arms.x; ++i) {
    lean = weightedLength(unlikeAt(at + segment * heading + reach * vec2(-heading.y, heading.x))) - lean;
    reach = -reach;
  }
  lean = clamp(kLean * reach * lean, -kMost * segment, kMost * segment);
  vec2 way = segment * heading + lean * vec2(-heading.y, heading.x);
  return way * inversesqrt(dot(way, way));
}

const float kBehind = 0.025;  // of the image's width: so far strokes go on behind models

// Where fidelity is 1 (fidelity.glsl), of an arm's length and of the colour threshold; and how much
// more detail counts.
const float kFaithfulSteps = 0.32;
const float kFaithfulThreshold = 0.45;
const float kFaithfulDetail = 1.5;
float fidelityHere() { return isModel ? 0.0 : walks[gl_LocalInvocationIndex].fidelity; }
float stepsOfArm() { return steps * mix(1.0, kFaithfulSteps, fidelityHere()); }
float threshold() {
  return colourThreshold * mix(1.0, kFaithfulThreshold, fidelityHere());
}

// Ends an arm after so many steps.
void endArm(int number, float length) { walked[number].length = min(steps, length); }

// Walks an arm, ahead or behind, and stores it. Behind its end, only its directions go on.
void walk(int side, vec2 from, Support on) {
  bool mayLeave = clips && (isModel || reachesLabels(from));
  // The camera image goes on behind a model: strokes do, too, and are clipped where it is drawn. The
  // background's do not go far: nothing is known of what is there. Movers' are not asked.
  bool goesBehind = mayLeave && !isModel;
  float left = kBehind * fullSize.x;
  int number = side * kWalkers + int(gl_LocalInvocationIndex);
  walked[number] = Arm(vec3(0.0), 0.0, steps, 0.0);
  bool goesOn = true;
  vec2 at = from;
  vec2 heading = walks[gl_LocalInvocationIndex].heading;
  if (side != 0) heading = -heading;
  float strayed = 0.0;
  for (int i = 0; i < arms.y; ++i) {
    vec2 direction = directionAt(at + 0.5 * segment * heading, on);
    vec2 hand = walks[gl_LocalInvocationIndex].hand;
    direction = vec2(hand.x * direction.x - hand.y * direction.y,
                     hand.y * direction.x + hand.x * direction.y);
    float along = dot(direction, heading);
    if (along < 0.0) direction = -direction;
    heading = direction;
    if (goesOn && i > 0 && abs(along) < cutOff) {
      endArm(number, float(i));
      goesOn = false;
    }
    if (!isModel) heading = steered(at, heading);
    ways[wayAt(side * kArm + i)] = heading;
    at += segment * heading;
    if (!goesOn) continue;
    goesOn = false;
    if (mayLeave) {
      // An arm ends where another surface begins.
      float part = partOnPatch(at, heading, on, strayed);
      if (part < 1.0) {
        endArm(number, float(i) + part);
        continue;
      }
    }
    if (goesBehind && isPatch(labelAt(at))) {
      if (left < segment) endArm(number, float(i) + left / segment);
      goesOn = left >= segment;
      left -= segment;
      continue;
    }
    if (clips && isBeyond(at, on)) {
      // It does not cross a mover's border.
      bool isEarly = isBeyond(at - 0.5 * segment * heading, on);
      endArm(number, float(i) + (isEarly ? 0.25 : 0.75));
      continue;
    }
    if (detailAt(at, on) < 0.4 * detailBand.x) {
      // A finer layer's stroke does not enter regions of coarser layers.
      endArm(number, max(float(i) + 0.5, minSteps));
      continue;
    }
    vec3 own = walks[gl_LocalInvocationIndex].colour;
    vec3 there = colourAt(at, on);
    float difference = apart(there, own);
    float most = threshold();
    if (difference > most) {
      float before = walked[number].difference;
      float part = clamp((most - before) / max(difference - before, 1e-4), 0.0, 1.0);
      endArm(number, max(float(i) + part, minSteps));
      continue;
    }
    goesOn = true;
    walked[number].difference = difference;
    if (float(i) >= steps) continue;
    float weight = 1.0 - 0.7 * difference / most;
    walked[number].colour += weight * there;
    walked[number].weight += weight;
  }
}
