// Purpose: what a stroke is painted on, and the direction, the colour and the detail that it finds
//          there: those of its own patch, segment or layer.
// Defines: ON_MODELS: strokes on models; MOVERS_ONLY: strokes on movers, and those of the background
//          that reach neither objects nor segments (stroke_lists.comp): ids, labels and depth are not
//          read; neither: the background's that may reach them.
// Inputs:  field: tensors to follow, detailField: tensors with the detail, both of virtual objects
//          with ON_MODELS, of the background else; moverField: those of movers; each with its
//          scale, px of the full image to texture coordinates; mover_places.glsl's and
//          mover_motion.glsl's; paint, modelPaint, moverPaint: the reduced images of the
//          background, of models and of movers; finePaint, fineGround: the finest of models and of
//          the background; paintTexel: the width of modelPaint's texels, px of the full image;
//          labels, but with MOVERS_ONLY: of pixels, in the lower bits of ArFrame::forms or of
//          StrokeSet::update()'s borders, which labelMask tells; hasSegments: they have segments'
//          labels, too; fullSize, px; pixelsOfFull: pixels of `labels` to a px of the full image;
//          modelDetail: factor of the detail on virtual surfaces; looseness, and loosePx: the
//          mover's motion, px a frame, from which and up to which it grows; clips: strokes end at
//          the borders of models, patches and movers.
// Outputs: functions. Precision: highp.
#include "pipeline/marks/movers/shaders/mover_places.glsl"
#include "pipeline/marks/movers/shaders/mover_motion.glsl"
#include "pipeline/marks/strokes/shaders/stroke_border.glsl"
#include "pipeline/scene/render/shaders/surface_form.glsl"
uniform highp sampler2D field;
uniform highp sampler2D detailField;
uniform highp sampler2D moverField;
uniform highp sampler2D paint;
uniform highp sampler2D modelPaint;
uniform highp sampler2D moverPaint;
uniform highp sampler2D finePaint;
uniform highp sampler2D fineGround;
uniform float paintTexel;
uniform highp usampler2D labels;
uniform uint labelMask;
#ifdef ON_MODELS
const bool isModel = true;  // what the stroke is on
#else
const bool isModel = false;
#endif
#ifdef MOVERS_ONLY
const bool mayBeOnMover = true;
const bool hasLabels = false;
const bool hasSegments = false;
#else
const bool mayBeOnMover = false;
const bool hasLabels = true;
uniform bool hasSegments;
#endif
uniform vec2 fullSize;
uniform vec2 pixelsOfFull;
uniform vec2 fieldScale;  // px of the full image to texture coordinates of the fields
uniform vec2 detailScale;
uniform vec2 moverScale;
uniform float modelDetail;  // factor of the detail on virtual surfaces
uniform float looseness;
uniform vec2 loosePx;  // a frame
uniform bool clips;  // strokes end at the borders of models, patches and movers

const vec2 kUpright = vec2(1.0, 0.0);  // a tensor: strokes of movers without any edge

// What the stroke is painted on.
struct Support {
  uint label;
  bool isMixed;  // the reduced image mixes its colours with those of what is beside it
  bool isOnMover;
  int mover;  // its number
};

// How much looser each invocation's mover is painted, in [0, 1], and a tensor, of strokes along
// the mover's motion. In registers, they would leave none to the walk.
const int kWalkers = 64;
shared vec3 loose[kWalkers];
vec3 looseOf() { return mayBeOnMover ? loose[gl_LocalInvocationIndex] : vec3(0.0, kUpright); }

ivec2 pixelAt(vec2 px) {
  return clamp(ivec2(floor(px * pixelsOfFull)), ivec2(0), textureSize(labels, 0) - 1);
}

uint labelsAt(vec2 px) { return hasLabels ? texelFetch(labels, pixelAt(px), 0).r : 0u; }
// The label of a surface; movers are told by mover_places.glsl.
uint labelOfSurface(uint texel) {
  uint label = texel & labelMask;
  return isMoverLabel(label) ? 0u : label;
}
uint labelAt(vec2 px) { return labelOfSurface(labelsAt(px)); }

// Whether a step from one pixel of `labels` to the next goes over a joint of a smooth surface.
bool isOverJoint(uint from, uint to) {
  return hasSegments ? isOpen(to) && otherOf(to) == ownOf(from) : isOneJoint(from, to);
}

// Whether another patch is within a texel of the reduced image, at a third of it, two or all.
bool isMixedAt(vec2 px, uint label, bool hasOthers) {
  int taps = hasOthers ? 12 : 0;
  for (int i = 0; i < taps; ++i) {
    float reach = paintTexel * float(1 + i / 4) / 3.0;
    float side = (i & 1) == 0 ? -reach : reach;
    vec2 arm = (i & 2) == 0 ? vec2(side, 0.0) : vec2(0.0, side);
    if (!mayCover(label, labelAt(px + arm))) return true;
  }
  return false;
}

Support supportOf(uint label, bool isOnMover, vec2 px) {
  int mover = isOnMover ? moverOfLabel(label) : 1;
  Support on = Support(label, false, isOnMover, mover);
  bool hasOthers = isModel || (hasSegments && !isOnMover && label != 0u);
  on.isMixed = isOnMover ? clips && isNearAnother(px, mover, 2.0 * paintTexel)
                         : isMixedAt(px, label, clips && hasOthers);
  if (mayBeOnMover) loose[gl_LocalInvocationIndex] = vec3(0.0, kUpright);
  vec2 moved;
  if (!isOnMover || looseness <= 0.0 || !findMoverMotion(px, mover, moved)) return on;
  vec2 along = vec2(moved.y * moved.y - moved.x * moved.x, -2.0 * moved.x * moved.y) /
               max(dot(moved, moved), 1e-6);
  float looser = smoothstep(loosePx.x, max(loosePx.y, loosePx.x + 1e-3), length(moved));
  loose[gl_LocalInvocationIndex] = vec3(looseness * looser, along);
  return on;
}

vec2 directionAt(vec2 px, Support on) {
  vec2 tensor;
  if (on.isOnMover) {
    tensor = textureLod(moverField, px * moverScale, 0.0).xy;
    tensor = dot(tensor, tensor) > 1e-3 ? tensor : kUpright;
  } else {
    tensor = textureLod(field, px * fieldScale, 0.0).xy;
  }
  tensor *= inversesqrt(max(dot(tensor, tensor), 1e-12));
  vec3 looser = looseOf();
  tensor = mix(tensor, looser.yz, 0.8 * looser.x);
  tensor *= inversesqrt(max(dot(tensor, tensor), 1e-12));
  // Half the angle by square roots; the stroke runs across the gradient.
  vec2 gradient = vec2(sqrt(max(0.0, 0.5 + 0.5 * tensor.x)), sqrt(max(0.0, 0.5 - 0.5 * tensor.x)));
  if (tensor.y < 0.0) gradient.y = -gradient.y;
  return vec2(-gradient.y, gradient.x);
}

// Whether a place is beyond the border of the stroke's mover, or of the background.
bool isBeyond(vec2 px, Support on) {
  vec3 shares = sharesAt(px);
  return on.isOnMover ? shareOf(shares, on.mover) <= 0.5 : sumOf(shares) > 0.5;
}

// How much of the colour at a place is the stroke's own: of a patch or segment, all or nothing; of a
// mover beside another one, what is more its own.
float ownShareAt(vec2 px, Support on) {
  if (!on.isOnMover) return mayCover(on.label, labelAt(px)) ? 1.0 : 0.0;
  vec3 shares = sharesAt(px);
  return max(2.0 * shareOf(shares, on.mover) - sumOf(shares), 0.0);
}

// The colour of the stroke's own patch or layer, if any of it is near. Where the reduced image mixes
// it with others, that of places around. A compiler has no registers for two loops.
vec3 colourAt(vec2 px, Support on) {
  const float kOthers = 1e-3;  // weight of the other layer
  vec4 seen = vec4(0.0);
  float reach = (on.isOnMover ? 1.0 : 0.4) * paintTexel;
  int taps = on.isMixed ? 9 : 0;
  for (int i = 0; i < taps; ++i) {
    vec2 there = px + reach * (vec2(i % 3, i / 3) - 1.0);
    float own = ownShareAt(there, on);
    if (own <= 0.0) continue;
    there /= fullSize;
    seen += own * (isModel     ? textureLod(finePaint, there, 0.0)
                   : on.isOnMover ? textureLod(moverPaint, there, 0.0)
                                  : textureLod(fineGround, there, 0.0));
  }
  vec2 at = px / fullSize;
  bool hasNone = seen.a <= 0.0;
  if (isModel) {
    if (hasNone) seen = textureLod(modelPaint, at, 0.0);
  } else {
    vec4 mover = textureLod(moverPaint, at, 0.0);
    vec4 ground = textureLod(paint, at, 0.0);
    if (hasNone) seen = on.isOnMover ? mover : ground;
    seen += kOthers * (on.isOnMover ? ground : mover);
  }
  return seen.rgb / max(seen.a, 1e-4);
}

float detailAt(vec2 px, Support on) {
  const float kLooseDetail = 0.6;
  if (isModel) {
    return modelDetail * textureLod(detailField, px * detailScale, 0.0).w;
  }
  float detail = on.isOnMover ? textureLod(moverField, px * moverScale, 0.0).w
                              : textureLod(detailField, px * detailScale, 0.0).w;
  return mix(1.0, kLooseDetail, looseOf().x) * detail;
}
