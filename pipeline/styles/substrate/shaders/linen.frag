// Purpose: one seamless tile of primed linen, rendered once: plain weave with uneven, slightly wavy
//          threads, half filled by the priming.
// Inputs:  those of tile_noise.glsl.
// Outputs: RGBA8, as in paper.frag: R height, G light from the top left on that relief (0.5 is
//          flat), B and A a slow wander in x and y.
// Precision: highp.
#include "pipeline/styles/substrate/shaders/tile_noise.glsl"
layout(location = 0) out vec4 paper;

// per tile: a thread is 5 px; an even number, or the weave would have a seam
const float kThreads = 102.0;

// Height of a thread's ridge, with the thread's thickness at a place along it.
float ridge(float across, float along, uint salt) {
  float thread = floor(across + 0.5);
  vec2 place = vec2(mod(thread, kThreads) * 37.0, along * float(kTile) / kThreads);
  float thick = 0.75;
  for (int i = 0; i < 2 * one; ++i) {
    thick += (i == 0 ? 0.35 : 0.25) * noise(place, i == 0 ? 16 : 4, salt + uint(i));
  }
  return thick * (0.5 + 0.5 * cos(6.2831853 * across));
}

// The place that the slight waves of the threads bring here.
vec2 bentAt(vec2 at) {
  vec2 bent = at;
  for (int i = 0; i < 4 * one; ++i) {
    float part = (i < 2 ? 1.6 : 0.5) * noise(at, i < 2 ? 64 : 8, 31u + uint(i));
    bent += (i & 1) == 0 ? vec2(part, 0.0) : vec2(0.0, part);
  }
  return bent;
}

float heightAt(vec2 at) {
  vec2 thread = bentAt(at) * (kThreads / float(kTile));
  float over = cos(3.14159265 * thread.x) * cos(3.14159265 * thread.y);
  float woven = 0.0;  // squares of warp and weft
  for (int i = 0; i < 2 * one; ++i) {
    vec2 along = i == 0 ? thread : thread.yx;
    float height = ridge(along.x, along.y, i == 0 ? 41u : 51u) * (0.5 + (i == 0 ? 0.5 : -0.5) * over);
    woven += height * height;
  }
  float primed = 0.5;
  float fine = 0.0;
  for (int i = 0; i < 3 * one; ++i) {
    float part = noise(at, i == 0 ? 32 : i == 1 ? 16 : 4, 61u + uint(i));
    primed += i == 0 ? 0.3 * part : i == 1 ? 0.2 * part : 0.0;
    fine = part;
  }
  return 0.5 + (0.75 * sqrt(woven) - 0.3) * clamp(0.4 + primed, 0.3, 1.1) + 0.1 * fine;
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
