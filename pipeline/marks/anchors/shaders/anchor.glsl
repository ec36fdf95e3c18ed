// Purpose: an anchor in its slot (marks/anchors/anchor.h).
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
  uint ageAndRank;    // lower half: age in 1/1024 s, saturated; upper half: rank
  uint seed;
  uint surface;
  uint state;
};

const uint kSourceBits = 0x0Fu;
// The number of its mover, less 1, if kMover.
const uint kMoverNumberShift = 4u;
const uint kMoverNumberBits = 0x30u;
// Not alive: its place on a virtual surface is remembered (marks::AnchorSet). With kHidden, the place
// is not seen in this frame.
const uint kDormant = 0x80u;
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
const uint kCoveredShift = 16u;  // above it: for how long it is covered or dormant, in 1/256 s
const uint kMaxCovered = 0xFFFFu;

const uint kSourceUnknown = 0u;
const uint kSourceSurface = 1u;
const uint kSourcePlane = 2u;
const uint kSourcePicture = 3u;
const uint kSourceFeatures = 4u;
const uint kSourceFlow = 5u;
const uint kSourceStill = 6u;

const float kAgeUnits = 1024.0;  // units per second
const uint kMaxAge = 0xFFFFu;

float ageOf(uint ageAndRank) { return float(ageAndRank & kMaxAge) / kAgeUnits; }
uint aged(uint ageAndRank, float seconds) {
  uint age = min((ageAndRank & kMaxAge) + uint(kAgeUnits * seconds + 0.5), kMaxAge);
  return (ageAndRank & ~kMaxAge) | age;
}

// Of two anchors, the one of the higher rank goes first. A rank is the scale at which an anchor is
// needed: log2 of it, in 1/1024 octaves, from 2^-24 on.
const float kRankUnits = 1024.0;  // per octave
const float kRankOrigin = 24.0;
uint rankOf(uint ageAndRank) { return ageAndRank >> 16u; }
uint rankAt(float octaves) {
  return uint(clamp(kRankUnits * (octaves + kRankOrigin) + 0.5, 0.0, 65535.0));
}

// With kMover, from 1 on.
int moverOf(uint state) { return 1 + int((state & kMoverNumberBits) >> kMoverNumberShift); }
uint stateOnMover(int number) { return kMover | uint(number - 1) << kMoverNumberShift; }

bool isAlive(uint state) { return (state & kAlive) != 0u; }
// The state of a slot whose anchor has gone: those on virtual surfaces become dormant.
uint stateAfter(uint state, bool isOnVirtual) {
  return isOnVirtual && (state & kOnSurface) != 0u ? kDormant | kOnSurface | kHidden : 0u;
}

bool isDormant(uint state) { return (state & (kAlive | kDormant)) == kDormant; }
bool isCovered(uint state) { return (state & (kAlive | kCovered)) == (kAlive | kCovered); }
bool isStaying(uint state) {
  return (state & (kAlive | kDying | kHidden | kCovered)) == kAlive;
}
