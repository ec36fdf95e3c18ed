// Purpose: shared by both passes of the temporally filtered frame (marks/filtered_frame.h).
// Inputs:  picture (RGBA8, sRGB-coded); past (the previous frame's output, LINEAR); kept: the part
//          of the past's weight that remains; noise: sigma.
// Outputs: filtered (RGBA16F): colour; number of frames in it, below 0 on virtual objects.
// Precision: highp.
layout(binding = 0, rgba16f) writeonly uniform highp image2D filtered;
uniform sampler2D picture;
uniform sampler2D past;
uniform float kept;
uniform float noise;

// standard deviations of the colours around a pixel that the past may differ by
const float kSpread = 1.5;
const float kNoiseSpread = 2.0;  // standard deviations of the noise that the past may differ by
const float kMaxFrames = 64.0;

// The weight of a past whose place has this error, px.
float trustOf(float error) { return 1.0 - smoothstep(0.75, 2.0, error); }

bool isInside(vec2 at, ivec2 size) {
  return all(greaterThan(at, vec2(0.0))) && all(lessThan(at, vec2(size)));
}

// Blends the current colour with the past, weighted by `trust` and clamped by the sums of the nine
// colours around and of their squares.
vec4 averaged(vec3 now, vec3 before, float trust, vec3 sum, vec3 squares) {
  vec3 mean = sum * (1.0 / 9.0);
  vec3 square = squares * (1.0 / 9.0);
  vec3 reach = kSpread * sqrt(max(square - mean * mean, 0.0)) + kNoiseSpread * noise;
  vec3 then = clamp(before, mean - reach, mean + reach);
  float frames = kept > 0.0 ? kept * min(trust, kMaxFrames) : 0.0;  // avoids NaN without a past
  vec3 colour = frames > 0.0 ? (now + frames * then) / (1.0 + frames) : now;
  return vec4(colour, 1.0 + frames);
}
