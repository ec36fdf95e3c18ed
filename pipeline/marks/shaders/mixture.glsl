// Purpose: maps a colour to a limited palette.
// Inputs:  mixtures (styles::makeMixtures), colour: sRGB-coded in [0, 1].
// Outputs: the mixture, sRGB-coded; interpolated linearly between the entries of the look-up table.
// Precision: highp.
uniform highp sampler2D mixtures;

vec3 mixtureOf(vec3 colour) {
  int side = textureSize(mixtures, 0).y;
  vec3 at = colour * float(side - 1);
  ivec3 low = min(ivec3(at), ivec3(side - 2));
  vec3 part = at - vec3(low);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 8; ++i) {
    ivec3 step = ivec3(i & 1, (i >> 1) & 1, i >> 2);
    vec3 weight = mix(1.0 - part, part, vec3(step));
    ivec3 knot = low + step;
    sum += weight.x * weight.y * weight.z *
           texelFetch(mixtures, ivec2(knot.z * side + knot.x, knot.y), 0).rgb;
  }
  return sum;
}
