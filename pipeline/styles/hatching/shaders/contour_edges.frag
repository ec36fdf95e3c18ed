// Purpose: the difference of two Gaussians across the edges' direction (Kang et al., "Coherent line
//          drawing", 2007): below 0 on the dark side of an edge, above it on the light one.
// Inputs:  luma (luma.frag, LINEAR), size: px; field: the finest tensors, moverField
//          those of movers, fieldScale; mover_labels.glsl's; pixelsOfFull; step: px between taps,
//          which is the narrower Gaussian's width.
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

void main() {
  vec2 gradient = gradientAt(gl_FragCoord.xy);
  float difference = 0.0;
  for (int i = -4; i <= 4; ++i) {
    vec2 at = gl_FragCoord.xy + float(i) * step_ * gradient;
    int k = i < 0 ? -i : i;
    difference += (kNarrow[k] - kWide[k]) * textureLod(luma, at / size, 0.0).r;
  }
  edge = vec2(difference, 0.0);
}
