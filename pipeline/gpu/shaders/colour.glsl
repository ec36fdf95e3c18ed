// Purpose: conversions between colour spaces, shared by passes.
// Inputs, outputs: colours in [0, 1]. Precision: highp; linear light needs more than 10 bits.

// IEC 61966-2-1, exact.
vec3 linearFromSrgb(vec3 srgb) {
  return mix(pow((srgb + 0.055) / 1.055, vec3(2.4)), srgb / 12.92, lessThanEqual(srgb, vec3(0.04045)));
}

// The same with a polynomial for y^0.4: within 0.2/255 of the exact curve.
vec3 linearFromSrgbFast(vec3 srgb) {
  vec3 y = (srgb + 0.055) * (1.0 / 1.055);
  vec3 root = ((((2.121072 * y - 6.588469) * y + 8.066004) * y - 5.157318) * y + 2.353418) * y +
              0.206812;
  return mix(y * y * root, srgb * (1.0 / 12.92), lessThanEqual(srgb, vec3(0.04045)));
}

vec3 srgbFromLinear(vec3 linearRgb) {
  return mix(1.055 * pow(linearRgb, vec3(1.0 / 2.4)) - 0.055, linearRgb * 12.92,
             lessThanEqual(linearRgb, vec3(0.0031308)));
}
