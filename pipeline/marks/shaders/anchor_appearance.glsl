// Purpose: whether an anchor of the camera's picture is still seen, or something that is no model has come
//          before it: it remembers what it lies on in the two numbers that others keep barycentrics in.
// Inputs:  picture (ArFrame::colour) and fullSize; noise: sigma, in [0, 1].
// Outputs: looks: 1 + luma, and 4 * mismatch frames + 1 + red less blue; (0, 0): not looked at yet.
// Precision: highp.
uniform highp sampler2D picture;
uniform float noise;

const float kMismatchFrames = 4.0;    // after which it is hidden
const float kReach = 2.0;            // px of the full picture, that an anchor may be off
const float kSlack = 14.0 / 255.0;   // light changes
const float kNoiseSlack = 3.0;
const float kPace = 0.25;            // of what is learnt in a frame, as light goes slowly
const float kPerMismatch = 4.0;

struct Looks {
  vec2 mean;  // luma, red less blue
  vec2 low;
  vec2 high;
};

Looks looksAt(vec2 px) {
  Looks here = Looks(vec2(0.0), vec2(9.0), vec2(-9.0));
  for (int i = 0; i < 5; ++i) {
    vec2 at = i == 4 ? px : px + kReach * (2.0 * vec2(i & 1, i >> 1) - 1.0);
    vec3 c = textureLod(picture, at / fullSize, 0.0).rgb;
    vec2 value = vec2(dot(c, vec3(0.299, 0.587, 0.114)), c.r - c.b);
    here.mean += 0.2 * value;
    here.low = min(here.low, value);
    here.high = max(here.high, value);
  }
  return here;
}

// What is remembered after this frame.
vec2 remembered(vec2 looks, vec2 px) {
  Looks here = looksAt(px);
  if (looks.y == 0.0) return here.mean + 1.0;
  float mismatch = floor(looks.y / kPerMismatch);
  vec2 known = vec2(looks.x, looks.y - kPerMismatch * mismatch) - 1.0;
  float slack = kSlack + kNoiseSlack * noise;
  bool isKnown = all(greaterThan(known, here.low - slack)) && all(lessThan(known, here.high + slack));
  mismatch = clamp(mismatch + (isKnown ? -1.0 : 1.0), 0.0, kMismatchFrames);
  if (isKnown) known += kPace * (here.mean - known);
  return known + 1.0 + vec2(0.0, kPerMismatch * mismatch);
}

// It was seen to be hidden, and has not been seen long enough since.
bool isMismatch(vec2 looks, bool wasHidden) {
  return looks.y >= kPerMismatch * (wasHidden ? 1.0 : kMismatchFrames);
}
