// Purpose: how much more exactly than the rest a place is depicted (marks::FinePlaces).
// Inputs:  finePlaces: upright ellipses: their centres, px of the full image, and 1 / radii;
//          fineShares: how much, in [0, 1], four in a vector; finePlaceCount: of them.
// Outputs: in [0, 1].
// Precision: highp.
uniform vec4 finePlaces[8];
uniform vec4 fineShares[2];
uniform int finePlaceCount;

const float kFineBorder = 1.3;  // radii from the centre, where a place has faded out

float finelyAt(vec2 px) {
  float most = 0.0;
  for (int i = 0; i < finePlaceCount; ++i) {
    float radii = length((px - finePlaces[i].xy) * finePlaces[i].zw);
    most = max(most, fineShares[i >> 2][i & 3] * (1.0 - smoothstep(1.0, kFineBorder, radii)));
  }
  return most;
}
