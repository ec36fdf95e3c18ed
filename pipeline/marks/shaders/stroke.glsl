// Purpose: what is kept of a stroke in its anchor's slot, from frame to frame (thesis §5.4).
// Inputs, outputs: directions are unit vectors in px of the full picture, away from the anchor.
// Precision: highp.
const int kArm = 4;  // segments on each side of the anchor

struct Stroke {
  vec4 ahead[2];   // four directions
  vec4 behind[2];
  vec2 lengths;    // of what is seen of each arm, in segments
  float exists;    // how much of it is there, in [0, 1]
  float wanted;    // whether it is to be, with hysteresis
  vec3 colour;     // sRGB-coded
  float seen;      // exists, as its anchor fades
};
