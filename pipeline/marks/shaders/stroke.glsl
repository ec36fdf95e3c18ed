// Purpose: the state of a stroke, stored in its anchor's slot from frame to frame (thesis §5.4).
// Inputs, outputs: directions are unit vectors in px of the full image, away from the anchor.
// Precision: highp.
const int kArm = 4;  // segments on each side of the anchor

const uint kWanted = 0x80000000u;  // `exists` is to be 1; with hysteresis

struct Stroke {
  vec4 ahead[2];   // four directions
  vec4 behind[2];
  vec2 lengths;  // visible length of each arm, in segments
  float exists;  // opacity, in [0, 1]
  uint state;  // the label of what it lies on (stroke_label.glsl), and the flag below
  vec3 colour;     // sRGB-coded
  float seen;  // exists × its anchor's fade
};

uint labelOfStroke(uint state) { return state & 8191u; }
