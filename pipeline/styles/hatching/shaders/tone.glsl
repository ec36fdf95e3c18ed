// Purpose: the tone that lines have to render, and the width that it asks of a line.
// Inputs:  tone (tone.frag, LINEAR), fullSize; isInverted: lines are light on a dark ground;
//          darkness, gamma: the curve from luma to tone; band: the range of tone in which a set
//          goes from no line to all of them at their full width; swell: in (0, 1]: how much of its
//          band a line takes to grow to its full width; width: px; fidelity.glsl's.
// Outputs: tones in [0, 1], 0 for bare paper; widths in px of the full image.
// Precision: highp.
uniform highp sampler2D tone;
uniform vec2 fullSize;
uniform bool isInverted;
uniform float darkness;
uniform float gamma;
uniform vec2 band;
uniform float swell;
uniform float width;

#include "pipeline/marks/shaders/fidelity.glsl"

// Lines leave faces to contours: of the tone, where fidelity is 1.
const float kFaithfulTone = 0.5;

// `isFront`: of models and movers; else of the background, which is known behind movers. `isModel`:
// what is before a face is none.
float toneAt(vec2 px, bool isFront, bool isModel) {
  const float kOthers = 1e-3;  // weight of the other layer
  vec4 seen = textureLod(tone, px / fullSize, 0.0);
  vec2 own = isFront ? seen.zw + kOthers * seen.xy : seen.xy + kOthers * seen.zw;
  float luma = own.x / max(own.y, 1e-5);
  float dark = isInverted ? luma : 1.0 - luma;
  float fidelity = isModel ? 0.0 : fidelityAt(px);
  return pow(clamp(darkness * dark, 0.0, 1.0), gamma) * mix(1.0, kFaithfulTone, fidelity);
}

// Nested: a line that exists at a tone exists at all darker ones and is no thinner there, so what a
// lighter tone shows is a part of what a darker one does.
float halfWidthOf(float tone_, float rank) {
  float inBand = clamp((tone_ - band.x) / (band.y - band.x), 0.0, 1.0);
  float past = clamp((inBand - rank * (1.0 - swell)) / swell, 0.0, 1.0);
  return 0.5 * width * past * past * (3.0 - 2.0 * past);
}
