// Purpose: what blurring a shadow's map across and down share. Each texel of a caster spreads over
//          a tent as wide as the light is from its height (penumbrae grow with height), separably:
//          a gathering of what would be scattered.
// Inputs:  radiusTexels: of a tent at height 0, and what height 1 adds; contactTexels: of the tent
//          for ambient light; contactHeight: from where on that is not kept off.
// Outputs: none. Precision: highp.
uniform vec2 radiusTexels;
uniform float contactTexels;
uniform float contactHeight;

const int kReach = 12;  // texels; wider tents are cut

// A tent whose values at whole texels add up to 1.
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
