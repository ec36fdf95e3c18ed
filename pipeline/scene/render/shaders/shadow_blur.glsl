// Purpose: shared by the horizontal and the vertical blur of a shadow map. Each texel of a caster
//          spreads over a tent as wide as the light is as seen from its height (penumbrae grow with
//          height), separably; implemented as gathering.
// Inputs:  radiusTexels: of a tent at height 0, and the increase for height 1; contactTexels: of the
//          tent for ambient light; contactHeight: height from which ambient light is not blocked.
// Outputs: none. Precision: highp.
uniform vec2 radiusTexels;
uniform float contactTexels;
uniform float contactHeight;

const int kReach = 12;  // texels; wider tents are truncated

// A tent whose values at whole texels sum to 1.
float tent(float distance, float radius) {
  float r = clamp(radius, 1.0, float(kReach) + 1.0);
  return max(0.0, 1.0 - distance / r) / r;
}

float keyWeight(float distance, float height) {
  return tent(distance, radiusTexels.x + radiusTexels.y * height);
}

float contactWeight(float distance) {
  return tent(distance, contactTexels);
}
