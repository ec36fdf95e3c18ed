// Purpose: the difference of two Gaussians across the edges' direction (Kang et al., "Coherent line
//          drawing", 2007): below 0 on the dark side of an edge, above it on the light one.
// Inputs:  luma (luma.frag, LINEAR), size: px; field: the finest tensors, moverField
//          those of movers, fieldScale; mover_labels.glsl's; pixelsOfFull; step_:
//          px between taps, which is the narrower Gaussian's width.
// Outputs: RG16F: the difference, in luma.
// Precision: highp.
#include "pipeline/marks/movers/shaders/mover_labels.glsl"
#include "pipeline/styles/hatching/shaders/contour_field.glsl"
uniform sampler2D luma;
uniform float step_;
layout(location = 0) out vec2 edge;

// Gaussians of 1 and 1.6 steps; each sums to 1.
const float kNarrow[5] = float[5](0.39905, 0.24204, 0.05401, 0.00443, 0.0);
const float kWide[5] = float[5](0.25071, 0.20624, 0.11479, 0.04323, 0.01039);

const float kFaithfulStep = 1.2;  // where fidelity is 1

// The difference along one axis.
float differenceAlong(vec2 axis) {
  float difference = 0.0;
  for (int i = -4; i <= 4; ++i) {
    vec2 at = gl_FragCoord.xy + float(i) * axis;
    int k = i < 0 ? -i : i;
    difference += (kNarrow[k] - kWide[k]) * textureLod(luma, at / size, 0.0).r;
  }
  return difference;
}

// What is small, such as an eye, has edges in directions that the field does not know: with fidelity,
// those along the other axis count, too.
void main() {
  float fidelity = fidelityOf(gl_FragCoord.xy);
  vec2 across = step_ * mix(1.0, kFaithfulStep, fidelity) * gradientAt(gl_FragCoord.xy);
  float difference = 0.0;
  int axes = fidelity > 0.0 ? 2 : 1;
  for (int i = 0; i < axes; ++i) {
    difference += (i == 0 ? 1.0 : fidelity) * differenceAlong(across);
    across = vec2(-across.y, across.x);
  }
  edge = vec2(difference, 0.0);
}
