// Purpose: conversions between colour spaces, shared by passes.
// Inputs, outputs: colours in [0, 1]. Precision: highp; linear light needs more than 10 bits.

// IEC 61966-2-1, exact.
vec3 linearFromSrgb(vec3 srgb) {
  return mix(pow((srgb + 0.055) / 1.055, vec3(2.4)), srgb / 12.92, lessThanEqual(srgb, vec3(0.04045)));
}

vec3 srgbFromLinear(vec3 linearRgb) {
  return mix(1.055 * pow(linearRgb, vec3(1.0 / 2.4)) - 0.055, linearRgb * 12.92,
             lessThanEqual(linearRgb, vec3(0.0031308)));
}
