// Purpose: how much more faithfully than the rest a place is depicted (marks::FidelityField).
// Inputs:  fidelityPlaces: upright ellipses: the centre, px of the full image, 1 / half the width,
//          and the fidelity; fidelityCount: of them.
// Outputs: in [0, 1].
// Precision: highp.
uniform vec4 fidelityPlaces[8];
uniform int fidelityCount;

const float kFidelityAspect = 1.4;  // height to width
const float kFidelityBorder = 1.3;  // radii from the centre, where a place has faded out

float fidelityAt(vec2 px) {
  float most = 0.0;
  for (int i = 0; i < fidelityCount; ++i) {
    vec4 place = fidelityPlaces[i];
    float radii = length((px - place.xy) * vec2(1.0, 1.0 / kFidelityAspect)) * place.z;
    most = max(most, place.w * (1.0 - smoothstep(1.0, kFidelityBorder, radii)));
  }
  return most;
}
