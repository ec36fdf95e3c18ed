// Purpose: compares a cell of the picture with the remembered background and with the previous frame
//          (marks/movers/motion_layers.h).
// Inputs:  motion_layers.glsl's, motion_layers_tally.glsl's, background_activity.glsl's; picture
//          (ArFrame::camera()); lastPicture, background, labels: the previous frame's, if hasPast;
//          motion: MotionField's field; noise: sigma of a cell, in [0, 1].
// Outputs: functions, which store candidates and evidence, as motion_layers.comp's.
// Precision: highp.
#include "pipeline/gpu/images/shaders/luma.glsl"
#include "pipeline/marks/movers/shaders/motion_layers.glsl"
#include "pipeline/marks/movers/shaders/motion_layers_tally.glsl"
#include "pipeline/marks/movers/shaders/background_activity.glsl"
layout(rgba8, binding = 0) writeonly uniform highp image2D candidates;
layout(rgba16f, binding = 1) writeonly uniform highp image2D evidence;
uniform highp sampler2D picture;
uniform highp sampler2D lastPicture;
uniform highp sampler2D background;
uniform highp sampler2D labels;
uniform highp sampler2D motion;
uniform bool hasPast;
uniform float noise;

const float kSlack = 0.035;
const float kNoiseDeviations = 3.0;
const float kMovingSlack = 1.6;  // of a camera that moves: the past is interpolated
const float kCertainThresholds = 2.4;  // at so many thresholds, other content is certain
const float kReach = 2.5;  // px
const float kMovedPx = 0.6;  // less may be an error of the flow, at any rate of frames
const float kLeastUnlike = 0.008;  // of colour

// A cell now, and where it was.
struct Seen {
  vec2 px;
  vec3 now;
  vec2 shift;
  vec2 from;
  float thing;
};

struct Compared {
  vec3 known;       // the background's colour
  float frames;     // in which that was seen
  float unlike;     // the background, of colour
  float other;      // how surely other content
  float changed;    // since the previous frame
  vec4 label;       // of the place in the previous frame
  vec4 moved;       // by dense flow
  bool isMoving;
  bool hasLeft;     // a mover has uncovered the place: the motion beside it is that mover's
};

// How surely the colour is the background's in a shadow, or in a little more light.
float shadeOf(vec3 now, vec3 known) {
  float before = lumaOf(known);
  float ratio = lumaOf(now) / max(before, 1e-3);
  if (before < 0.12 || ratio < 0.68 || ratio > 1.12) return 0.0;
  return 1.0 - smoothstep(0.5, 1.0, apart(now / ratio, known) / (kSlack + kNoiseDeviations * noise));
}

// A number for the real thing of an object, 0 for none. Few share one.
float thingOf(uint object) { return object < kRealObject ? 0.0 : 1.0 + float(object % 255u); }

Seen seenAt(ivec2 cell) {
  vec2 px = (vec2(cell) + 0.5) * kLayerCellPixels;
  vec2 shift = backgroundShift(px);
  return Seen(px, textureLod(picture, px / fullSize, 0.0).rgb, shift, px - shift,
              thingOf(objectAt(px)));
}

// Whether the cell showed another real thing in the previous frame.
bool isAnother(Seen cell) {
  if (!hasPast || !isInPicture(cell.from)) return false;
  ivec2 there = min(ivec2(cell.from / kLayerCellPixels), textureSize(lastPicture, 0) - 1);
  return abs(255.0 * texelFetch(lastPicture, there, 0).a - cell.thing) > 0.5;
}

Compared compared(Seen cell) {
  Compared c;
  vec3 low = cell.now;
  vec3 high = cell.now;
#ifndef AT_REST
  // While the camera moves, colours are compared with all those around.
  for (int i = isStanding ? 4 : 0; i < 4; ++i) {
    vec2 at = cell.px + kReach * (2.0 * vec2(i & 1, i >> 1) - 1.0);
    vec3 there = textureLod(picture, at / fullSize, 0.0).rgb;
    low = min(low, there);
    high = max(high, there);
  }
#endif
  vec4 known = pastAt(background, cell.from);
  c.known = known.rgb;
  c.frames = known.a;
  vec3 before = pastAt(lastPicture, cell.from).rgb;
  float least = (isStanding ? 1.0 : kMovingSlack) * (kSlack + kNoiseDeviations * noise);
  float certain = kCertainThresholds * least;
  float slack = slackOf(activityAt(cell.from));
  c.unlike = known.a < 0.5 ? 0.0 : beyond(known.rgb, low, high);
  c.other = smoothstep(least + slack, certain + slack, c.unlike);
  c.other *= 1.0 - shadeOf(cell.now, known.rgb);
  c.changed = smoothstep(least, certain, beyond(before, low, high));

  c.moved = textureLod(motion, cell.px / fullSize, 0.0);
  // Measured motion may still be that of most of the image.
  float otherwise = min(distance(c.moved.xy, cell.shift), distance(c.moved.xy, pictureShift(cell.px)));
  c.isMoving = c.moved.w > 0.5 && c.moved.z < 3.0 && otherwise > kMovedPx + 2.5 * c.moved.z;
  c.label = pastAt(labels, cell.from);
  if (!c.isMoving && c.changed > 0.5) c.label.a = 0.0;  // something else is seen there
  c.hasLeft = c.label.a < 0.0 && c.changed <= 0.5;
  return c;
}

bool mayBeMover(Compared c) {
  return !c.isMoving && !c.hasLeft &&
         (max(c.label.r, c.other) > 0.5 || c.unlike > kLeastUnlike + kNoiseDeviations * noise);
}

// `goes`: seconds in which it has been seen to move.
void store(ivec2 cell, vec3 now, Compared c, float goes) {
  imageStore(candidates, cell, vec4(c.other, c.label.r, lumaOf(now), lumaOf(c.known)));
  imageStore(evidence, cell, vec4(c.changed, c.label.b, c.label.a + goes, c.label.g));
}
