// Purpose: how different two colours are, roughly as they are perceived: luma counts most.
// Inputs:  sRGB-coded colours, or the difference of two.
// Outputs: a weighted length, in the same units.
// Precision: that of the colours.
const vec3 kColourWeights = vec3(0.9, 1.5, 0.6);

float weightedLength(vec3 difference) {
  return sqrt(dot(difference * difference, kColourWeights));
}

float apart(vec3 a, vec3 b) { return weightedLength(a - b); }
