// Purpose: one tile of watercolor paper that repeats without a seam, made once.
// Inputs:  none.
// Outputs: RGBA8: R height of a cold-pressed sheet, G light from the top left on that relief (0.5 is
//          flat), B and A a slow wander in x and y (0.5 is none).
// Precision: highp.
#include "pipeline/gpu/shaders/hash.glsl"
layout(location = 0) out vec4 paper;
const int kTile = 512;  // px, as in the code

// Perlin's gradient noise with a lattice of `spacing` px (a divisor of the tile), in about [-1, 1].
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

// Bumps of the felt, tooth and single fibres. The detour breaks up the lattice.
float heightAt(vec2 at) {
  vec2 bent = at + 2.4 * vec2(noise(at, 16, 11u), noise(at, 16, 12u));
  float slow = noise(at, 32, 4u);
  float felt = noise(bent, 8, 1u);
  float tooth = noise(bent, 4, 2u);
  float fine = noise(bent + 0.37, 2, 3u);
  return 0.5 + 0.08 * slow + 0.2 * felt + 0.26 * tooth + 0.16 * fine;
}

void main() {
  vec2 at = gl_FragCoord.xy;
  float height = heightAt(at);
  float slope = heightAt(at + vec2(1.0)) - heightAt(at - vec2(1.0));
  vec2 wander = vec2(noise(at, 16, 5u), noise(at, 16, 6u)) +
                0.5 * vec2(noise(at, 8, 7u), noise(at, 8, 8u));
  paper = vec4(height, 0.5 + 0.5 * slope, 0.5 + 0.4 * wander);
}
