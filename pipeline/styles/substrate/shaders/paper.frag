// Purpose: one seamless tile of watercolor paper, rendered once.
// Inputs:  none.
// Outputs: RGBA8: R height of cold-pressed paper, G light from the top left on that relief (0.5 is
//          flat), B and A a slow wander in x and y (0.5 is none).
// Precision: highp.
#include "pipeline/styles/substrate/shaders/tile_noise.glsl"
layout(location = 0) out vec4 paper;

// Bumps of the felt, tooth and single fibres. The domain warp breaks up the lattice.
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
