// Purpose: what both passes of the picture averaged over time have (marks/filtered_frame.h).
// Inputs:  picture (RGBA8, sRGB-coded); past (the output of the frame before, LINEAR); kept: the part
//          of the past's weight that this frame leaves; noise: sigma.
// Outputs: filtered (RGBA16F): colour; frames' worth of it, below 0 where a virtual object is seen.
// Precision: highp.
layout(binding = 0, rgba16f) writeonly uniform highp image2D filtered;
uniform sampler2D picture;
uniform sampler2D past;
uniform float kept;
uniform float noise;

const float kSpread = 1.5;       // of colours around a pixel: what the past may have
const float kNoiseSpread = 2.0;  // likewise, of the noise
const float kMostFrames = 64.0;

// How much the past counts whose place is known to so many px.
float trustOf(float error) { return 1.0 - smoothstep(0.75, 2.0, error); }

bool isInside(vec2 at, ivec2 size) {
  return all(greaterThan(at, vec2(0.0))) && all(lessThan(at, vec2(size)));
}

// The colour now and the past, which counts so much, as it may be by the sums of the nine colours
// around and of their squares.
vec4 averaged(vec3 now, vec3 before, float trust, vec3 sum, vec3 squares) {
  vec3 mean = sum * (1.0 / 9.0);
  vec3 square = squares * (1.0 / 9.0);
  vec3 reach = kSpread * sqrt(max(square - mean * mean, 0.0)) + kNoiseSpread * noise;
  vec3 then = clamp(before, mean - reach, mean + reach);
  float frames = kept > 0.0 ? kept * min(trust, kMostFrames) : 0.0;  // no past: no NaN of it
  vec3 colour = frames > 0.0 ? (now + frames * then) / (1.0 + frames) : now;
  return vec4(colour, 1.0 + frames);
}
