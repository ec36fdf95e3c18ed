// Purpose: whether an anchor of the camera image is still visible, or an object that is not a model
//          occludes it. The anchor remembers the appearance of its surroundings.
// Inputs:  picture (ArFrame::colour), background (marks::MotionLayers) and fullSize; noise: sigma,
//          in [0, 1].
// Outputs: looks: 1 + luma, and 4 * mismatch frames + 1 + red less blue; (0, 0): not sampled yet.
//          Anchors store it packed in 32 bits.
// Precision: highp.
#include "pipeline/gpu/images/shaders/luma.glsl"
#include "pipeline/marks/movers/shaders/mover_places.glsl"
uniform highp sampler2D picture;
uniform highp sampler2D background;
uniform float noise;

const float kMismatchFrames = 4.0;  // the anchor is hidden after so many
const float kReach = 2.0;  // px of the full image: error allowed in the anchor's position
const float kSlack = 14.0 / 255.0;  // allowance for changes of light
const float kNoiseSlack = 3.0;
const float kPace = 0.25;  // learning rate per frame, slow enough for changes of light
const float kPerMismatch = 4.0;

struct Looks {
  vec2 mean;  // luma, red less blue
  vec2 low;
  vec2 high;
};

// `scale`: from px of the full image to texture coordinates.
Looks looksAt(highp sampler2D image, vec2 scale, vec2 px) {
  Looks here = Looks(vec2(0.0), vec2(9.0), vec2(-9.0));
  for (int i = 0; i < 5; ++i) {
    vec2 at = i == 4 ? px : px + kReach * (2.0 * vec2(i & 1, i >> 1) - 1.0);
    vec3 c = textureLod(image, at * scale, 0.0).rgb;
    vec2 value = vec2(lumaOf(c), c.r - c.b);
    here.mean += 0.2 * value;
    here.low = min(here.low, value);
    here.high = max(here.high, value);
  }
  return here;
}

// From the lowest: 14 bits of red less blue, 14 of luma, 3 of mismatch frames, and 1 if sampled. The
// mean moves by a quarter of a difference, which 14 bits hold down to 1/16 of a level.
const float kPackedSteps = 16383.0;

uint packedLooks(vec2 looks) {
  if (looks.y == 0.0) return 0u;
  float mismatch = floor(looks.y / kPerMismatch);
  vec2 known = vec2(looks.x - 1.0, 0.5 * (looks.y - kPerMismatch * mismatch));
  uvec2 steps = uvec2(kPackedSteps * clamp(known, 0.0, 1.0) + 0.5);
  return 1u << 31 | uint(mismatch) << 28 | steps.x << 14 | steps.y;
}

vec2 unpackedLooks(uint stored) {
  if (stored == 0u) return vec2(0.0);
  vec2 known = vec2(stored >> 14 & 0x3FFFu, stored & 0x3FFFu) / kPackedSteps;
  return vec2(1.0 + known.x, kPerMismatch * float(stored >> 28 & 7u) + 2.0 * known.y);
}

vec2 knownOf(vec2 looks) {
  return vec2(looks.x, looks.y - kPerMismatch * floor(looks.y / kPerMismatch)) - 1.0;
}

bool isWithin(Looks here, vec2 known) {
  float slack = kSlack + kNoiseSlack * noise;
  return all(greaterThan(known, here.low - slack)) && all(lessThan(known, here.high + slack));
}

// The appearance to remember after this frame. Beside a mover, what is seen may be its outline.
vec2 remembered(vec2 looks, vec2 px, bool isBesideMover) {
  Looks here = looksAt(picture, 1.0 / fullSize, px);
  if (looks.y == 0.0) return here.mean + 1.0;
  float mismatch = floor(looks.y / kPerMismatch);
  vec2 known = knownOf(looks);
  bool isKnown = isWithin(here, known);
  mismatch = clamp(mismatch + (isKnown ? -1.0 : 1.0), 0.0, kMismatchFrames);
  if (isKnown && !isBesideMover) known += kPace * (here.mean - known);
  return known + 1.0 + vec2(0.0, kPerMismatch * mismatch);
}

// Whether the background, where it has been seen, is other than the anchor remembers.
bool isUnlikeBackground(vec2 looks, vec2 px) {
  if (looks.y == 0.0 || textureLod(background, inLayers(background, px), 0.0).a < 1.0) return false;
  return !isWithin(looksAt(background, inLayers(background, vec2(1.0)), px), knownOf(looks));
}

// Whether something has just come to rest here.
bool isNewBackground(vec2 px) { return textureLod(background, inLayers(background, px), 0.0).a < 4.0; }

// Whether its last frame was a mismatch.
bool isUnlike(vec2 looks) { return looks.y >= kPerMismatch; }

// Whether the anchor counts as occluded: a visible one from kMismatchFrames mismatches on, a hidden
// one until its count is back at 0.
bool isMismatch(vec2 looks, bool wasHidden) {
  return looks.y >= kPerMismatch * (wasHidden ? 1.0 : kMismatchFrames);
}
