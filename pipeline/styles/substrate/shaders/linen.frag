// Purpose: one seamless tile of primed linen, rendered once: plain weave with uneven, slightly wavy
//          threads, half filled by the priming.
// Inputs:  none.
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
  float thick = 0.75 + 0.35 * noise(place, 16, salt) + 0.25 * noise(place, 4, salt + 1u);
  return thick * (0.5 + 0.5 * cos(6.2831853 * across));
}

float heightAt(vec2 at) {
  vec2 bent = at + 1.6 * vec2(noise(at, 64, 31u), noise(at, 64, 32u)) +
              0.5 * vec2(noise(at, 8, 33u), noise(at, 8, 34u));
  vec2 thread = bent * (kThreads / float(kTile));
  float over = cos(3.14159265 * thread.x) * cos(3.14159265 * thread.y);
  float warp = ridge(thread.x, thread.y, 41u) * (0.5 + 0.5 * over);
  float weft = ridge(thread.y, thread.x, 51u) * (0.5 - 0.5 * over);
  float primed = 0.5 + 0.3 * noise(at, 32, 61u) + 0.2 * noise(at, 16, 62u);
  return 0.5 + (0.75 * sqrt(warp * warp + weft * weft) - 0.3) * clamp(0.4 + primed, 0.3, 1.1) +
         0.1 * noise(at, 4, 63u);
}

void main() {
  vec2 at = gl_FragCoord.xy;
  float slope = heightAt(at + vec2(1.0)) - heightAt(at - vec2(1.0));
  vec2 wander = vec2(noise(at, 16, 5u), noise(at, 16, 6u)) +
                0.5 * vec2(noise(at, 8, 7u), noise(at, 8, 8u));
  paper = vec4(heightAt(at), 0.5 + 0.5 * slope, 0.5 + 0.4 * wander);
}
