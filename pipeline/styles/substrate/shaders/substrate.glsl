// Purpose: the paper under a place of the picture. The substrate goes with the picture as a whole, so that
//          it is neither a dirty window before the scene nor slides under it, and its grain keeps its
//          size (Cunzi et al., "Dynamic canvas for immersive non-photorealistic walkthroughs", 2003).
// Inputs:  paper (paper.frag or linen.frag, LINEAR, repeating); paperLinear, paperShift: its px under the picture's,
//          as complex numbers; coarser: how much of the coarser octave is seen.
// Outputs: as paper.frag's.
// Precision: highp for places.
uniform sampler2D paper;
uniform vec2 paperLinear;
uniform vec2 paperShift;
uniform float coarser;
const float kPaperTexel = 1.0 / 512.0;

vec2 onPaper(vec2 pixel) {
  return vec2(paperLinear.x * pixel.x - paperLinear.y * pixel.y,
              paperLinear.x * pixel.y + paperLinear.y * pixel.x) + paperShift;
}

// `finer`: 1, or less for slower changes.
vec4 sheetAt(vec2 place, float finer) {
  vec2 at = place * (finer * kPaperTexel);
  vec4 substrate = texture(paper, at);
  if (coarser > 0.004) {
    vec4 other = texture(paper, 0.5 * at);
    // Uncorrelated: the blend would be paler than either.
    float paler = inversesqrt(coarser * coarser + (1.0 - coarser) * (1.0 - coarser));
    substrate = 0.5 + paler * mix(substrate - 0.5, other - 0.5, coarser);
  }
  return substrate;
}
