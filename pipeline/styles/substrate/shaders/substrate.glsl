// Purpose: the paper under a place of the image. The substrate moves with the image as a whole: it
//          neither looks like a dirty window before the scene nor slides under it, and its grain
//          keeps its size (Cunzi et al., "Dynamic canvas for immersive non-photorealistic
//          walkthroughs", 2003).
// Inputs:  paper (paper.frag or linen.frag, LINEAR, repeating); paperLinear, paperShift: map px of
//          the image to px of the paper, as complex numbers; coarser: weight of the coarser octave.
// Outputs: as in paper.frag.
// Precision: highp for places.
#include "pipeline/styles/substrate/shaders/tile.glsl"
uniform sampler2D paper;
uniform vec2 paperLinear;
uniform vec2 paperShift;
uniform float coarser;
const float kPaperTexel = 1.0 / float(kTile);

vec2 onPaper(vec2 pixel) {
  return vec2(paperLinear.x * pixel.x - paperLinear.y * pixel.y,
              paperLinear.x * pixel.y + paperLinear.y * pixel.x) + paperShift;
}

// `finer`: 1, or less for slower variation.
vec4 sheetAt(vec2 place, float finer) {
  vec2 at = place * (finer * kPaperTexel);
  vec4 substrate = texture(paper, at);
  if (coarser > 0.004) {
    vec4 other = texture(paper, 0.5 * at);
    // The octaves are uncorrelated, so that blending them would lower the contrast; this restores
    // it.
    float paler = inversesqrt(coarser * coarser + (1.0 - coarser) * (1.0 - coarser));
    substrate = 0.5 + paler * mix(substrate - 0.5, other - 0.5, coarser);
  }
  return substrate;
}
