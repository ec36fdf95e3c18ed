// Purpose: one seamless tile of watercolor paper, rendered once.
// Inputs:  those of tile_noise.glsl.
// Outputs: RGBA8: R height of cold-pressed paper, G light from the top left on that relief (0.5 is
//          flat), B and A a slow wander in x and y (0.5 is none).
// Precision: highp.
#include "pipeline/styles/substrate/shaders/tile_noise.glsl"
layout(location = 0) out vec4 paper;

// Of the slow octave, felt, tooth and single fibres, after the two of the domain warp, which breaks
// up the lattice.
const int kSpacing[6] = int[6](16, 16, 32, 8, 4, 2);
const uint kSalt[6] = uint[6](11u, 12u, 4u, 1u, 2u, 3u);
const float kWeight[6] = float[6](2.4, 2.4, 0.08, 0.2, 0.26, 0.16);

float heightAt(vec2 at) {
  vec2 bent = at;
  float height = 0.5;
  for (int i = 0; i < 6 * one; ++i) {
    vec2 place = i < 3 ? at : i < 5 ? bent : bent + 0.37;
    float part = kWeight[i] * noise(place, kSpacing[i], kSalt[i]);
    bent += i == 0 ? vec2(part, 0.0) : i == 1 ? vec2(0.0, part) : vec2(0.0);
    height += i < 2 ? 0.0 : part;
  }
  return height;
}

void main() {
  vec2 at = gl_FragCoord.xy;
  float height = 0.0;
  float slope = 0.0;
  for (int i = 0; i < 3 * one; ++i) {
    float side = i == 0 ? 0.0 : i == 1 ? 1.0 : -1.0;
    float there = heightAt(at + side);
    height = i == 0 ? there : height;
    slope += side * there;
  }
  paper = vec4(height, 0.5 + 0.5 * slope, 0.5 + 0.4 * wanderAt(at));
}
