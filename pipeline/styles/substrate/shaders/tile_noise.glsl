// Purpose: noise with the period of the substrate's tile.
// Inputs:  places, px of the tile; one: 1, which no compiler knows. As a factor of their bounds it
//          keeps loops over octaves from being unrolled: compiling them took tens of seconds.
// Outputs: noise in about [-1, 1].
// Precision: highp.
#include "pipeline/gpu/shaders/hash.glsl"
#include "pipeline/styles/substrate/shaders/tile.glsl"
uniform int one;

// Perlin's gradient noise with a lattice of `spacing` px (a divisor of the tile).
float noise(vec2 at, int spacing, uint salt) {
  vec2 scaled = at / float(spacing);
  ivec2 base = ivec2(floor(scaled));
  vec2 f = scaled - vec2(base);
  vec2 w = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
  float corners[4];
  for (int i = 0; i < 4; ++i) {
    ivec2 step = ivec2(i & 1, i >> 1);
    ivec2 knot = (base + step) & ivec2(kTile / spacing - 1);
    float angle = unitOf(hashOf(knot, salt)) * 6.2831853;
    corners[i] = dot(vec2(cos(angle), sin(angle)), f - vec2(step));
  }
  return 1.5 * mix(mix(corners[0], corners[1], w.x), mix(corners[2], corners[3], w.x), w.y);
}

// A slow wander in x and y.
vec2 wanderAt(vec2 at) {
  vec2 wander = vec2(0.0);
  for (int i = 0; i < 4 * one; ++i) {
    float part = (i < 2 ? 1.0 : 0.5) * noise(at, i < 2 ? 16 : 8, 5u + uint(i));
    wander += (i & 1) == 0 ? vec2(part, 0.0) : vec2(0.0, part);
  }
  return wander;
}
