// Purpose: the state of a stroke, stored in its anchor's slot from frame to frame (thesis §5.4).
// Inputs, outputs: px of the full image; directions lead away from the anchor. They are unit vectors;
//          on virtual objects, whose surfaces stretch, as long as the stretch.
// Precision: highp.
const int kArm = 4;  // segments on each side of the anchor

const uint kWanted = 0x80000000u;  // `exists` is to be 1; with hysteresis
const uint kAccent = 0x40000000u;  // depicts something narrow: painted after the others

struct Stroke {
  vec2 ways[2 * kArm];  // directions: of the arm ahead of the anchor, then of the one behind it
  vec2 lengths;  // visible length of each arm, in segments
  float exists;  // opacity, in [0, 1]
  uint state;  // the label of what it lies on (stroke_label.glsl), its girth, and the flags above
  vec3 colour;     // sRGB-coded
  float seen;  // exists × its anchor's fade
};

uint labelOfStroke(uint state) { return state & 8191u; }

// Of the width, in [1/2, 2): on models, the stretch of the surface across the stroke. 0 stands for 1.
const int kGirthBits = 12;
const int kGirthShift = 13;
float girthOf(uint state) {
  return exp2(float(bitfieldExtract(int(state), kGirthShift, kGirthBits)) / 2048.0);
}
// A stroke's fidelity (fidelity.glsl) is kept as its girth, but on models, where girth is the
// surface's.
const float kFaithfulGirth = 0.55;  // where fidelity is 1
float girthOfFidelity(float fidelity) { return mix(1.0, kFaithfulGirth, fidelity); }
float fidelityOf(uint state) {
  return clamp((1.0 - girthOf(state)) / (1.0 - kFaithfulGirth), 0.0, 1.0);
}
uint withGirth(uint state, float girth) {
  int octaves = int(round(2048.0 * clamp(log2(girth), -1.0, 0.999)));
  return bitfieldInsert(state, uint(octaves), kGirthShift, kGirthBits);
}
