// Purpose: an anchor in its slot (marks/anchor.h).
// Inputs, outputs: px of the full picture.
// Precision: highp.
struct Anchor {
  vec2 px;
  vec2 displacement;
  vec4 jacobian;  // column-major
  uint barycentrics;  // packUnorm2x16, if kOnSurface
  uint appearance;    // anchor_appearance.glsl
  float error;
  float fade;
  float age;
  uint seed;
  uint surface;
  uint state;
};

const uint kSourceBits = 0xFFu;
const uint kAlive = 0x100u;
const uint kDying = 0x200u;
const uint kHidden = 0x400u;
const uint kBorn = 0x800u;
// A mover covers it: its mark stays as it is and is clipped.
const uint kCovered = 0x1000u;
const uint kMover = 0x2000u;  // on a mover
const uint kOnSurface = 0x4000u;  // its triangle and barycentrics are known
// Another part of the same real thing is before it: told by anchor_surface.comp to anchor_image.comp.
const uint kTurnedAway = 0x8000u;
const uint kCoveredShift = 16u;  // above it: for how long, in 1/256 s
const uint kMaxCovered = 0xFFFFu;

const uint kSourceUnknown = 0u;
const uint kSourceSurface = 1u;
const uint kSourcePlane = 2u;
const uint kSourcePicture = 3u;
const uint kSourceFeatures = 4u;
const uint kSourceFlow = 5u;
const uint kSourceStill = 6u;

bool isAlive(uint state) { return (state & kAlive) != 0u; }
bool isCovered(uint state) { return (state & (kAlive | kCovered)) == (kAlive | kCovered); }
bool isStaying(uint state) {
  return (state & (kAlive | kDying | kHidden | kCovered)) == kAlive;
}
