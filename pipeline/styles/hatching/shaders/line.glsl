// Purpose: the state of a hatching line, stored in its anchor's slot from frame to frame.
// Inputs, outputs: directions are unit vectors in px of the full image, away from the anchor.
// Precision: highp.
const int kArm = 8;  // segments on each side of the anchor

struct Line {
  uvec4 ways[4];  // kArm directions ahead of the anchor, then as many behind it: packSnorm2x16
  vec2 lengths;   // of each arm, in segments
  float rank;     // the line exists where its set's tone exceeds it; in [0, 1), for life
  float seen;     // half of its largest width, px
  vec2 shift;     // from the anchor to the line, px
  float bend;     // random for life: how the hand strays, in [-1, 1]
  uint label;     // of what it lies on (line_support.glsl)
};
